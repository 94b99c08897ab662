//! Every kernel holds what its scene uses and nothing else. Proved on the composed text, without an adapter.
//!
//! What is composed, and why not all: [`choices`].

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::ops::Range;
use std::path::Path;
use std::sync::LazyLock;

use hexroll::engine::StageSetup;
use hexroll::gpu::chains::{self, Chains};
use hexroll::gpu::compose::scan::scan;
use hexroll::gpu::compose::{Choice, Composed as Program, Kernel, PARTS, RimKind};
use hexroll::gpu::layout::{self, Real, Wgsl};
use hexroll::gpu::{Counts, Precision, order};
use hexroll::model::Model;
use hexroll::scene::{Drive, Friction, Law};
use hexroll_lab::rig::{ELEMENTS, Random, laws, shipped};
use naga::{ArraySize, Block, Expression, Function, GlobalVariable, Handle, Module, Statement, TypeInner};

/// No road; a plane and a drum without friction and with every friction law; and every other road with one of pressure and speed: a
/// friction law asks nothing of a road but its velocity and what rounding hides of it.
fn roads() -> Vec<(Option<&'static str>, Option<Friction>)> {
    let frictions = || Friction::KINDS.iter().map(|kind| Some((kind.example)()));
    let of = |road| {
        let all = std::iter::once(None).chain(frictions());
        let asks_all = |friction: &Option<Friction>| friction.is_some_and(|law| law.needs_area());
        all.filter(move |f| ROADS[..2].contains(&road) || asks_all(f)).map(move |f| (Some(road), f))
    };
    std::iter::once((None, None)).chain(ROADS.into_iter().flat_map(of)).collect()
}

/// Roads by their names in scenes.
const ROADS: [&str; 6] = ["plane", "drum", "disk", "wave", "profile", "height-field"];

/// How many ways there are to decide each thing, in the order of [`choice`]: five that an element is made of, the place of
/// elements and nodes (table, lattice, lattice whose chains are joined), five that a node is made of, the precision.
fn ways() -> Decided {
    [ELEMENTS.len(), Law::KINDS.len(), 2, 2, 3, 3, roads().len(), 2, 2, 2, 3, Precision::ALL.len()]
}

const LAW: usize = 1;
const ROAD: usize = 6;
const ELEMENT: Range<usize> = 0..5;
const PLACE: Range<usize> = 5..6;
const NODE: Range<usize> = 6..11;

/// Which way each thing is decided.
type Decided = [usize; 12];

fn choice(decided: &Decided) -> Choice {
    let [element, law, extruded, shared, viscous, place, road, held, gravity, damping, rim, precision] =
        *decided;
    let (road, friction) = roads()[road];
    Choice {
        element: ELEMENTS[element],
        law: laws().nth(law).unwrap(),
        extruded: extruded == 1,
        shared_classes: shared == 1,
        viscous: viscous > 0,
        relaxes: viscous > 1,
        lattice: place > 0,
        joined: place > 1,
        road,
        friction,
        held: held == 1,
        gravity: gravity == 1,
        damping: damping == 1,
        rim: [RimKind::None, RimKind::Prescribed, RimKind::Free][rim],
        precision: PRECISIONS[precision],
    }
}

/// In this order: the full product is taken in the first.
const PRECISIONS: [Precision; 3] = [Precision::F32, Precision::F32Plus, Precision::F64];

/// What a kernel's program depends on, of all that is decided.
fn deciding(kernel: Kernel) -> Vec<usize> {
    match kernel {
        Kernel::ElementForce | Kernel::ElementEnergy => [0, 1, 2, 3, 4, 5, 11].into(),
        Kernel::Boundary | Kernel::NodeProbe => (5..12).collect(),
        // Neither road nor rim.
        Kernel::Node => [5, 7, 8, 9, 11].into(),
        Kernel::Rim => [5, 8, 11].into(),
        Kernel::Gather => [5, 11].into(),
        Kernel::Resident => (0..12).collect(),
        Kernel::SurfaceState | Kernel::Watch | Kernel::Reduce | Kernel::Rebase | Kernel::CheckSums => {
            [11].into()
        }
    }
}

/// What decides this kernel of a choice.
fn key(kernel: Kernel, decided: &Decided) -> (Kernel, Vec<usize>) {
    (kernel, deciding(kernel).into_iter().map(|k| decided[k]).collect())
}

/// Every way to decide a range of things, the others 0.
fn product(range: Range<usize>) -> Vec<Decided> {
    let ways = ways();
    range.fold(vec![[0; 12]], |all, k| {
        let each = |decided: Decided| {
            (0..ways[k]).map(move |way| {
                let mut decided = decided;
                decided[k] = way;
                decided
            })
        };
        all.into_iter().flat_map(each).collect()
    })
}

/// Of all choices, in random order, those that bring a new pair: any two things are decided in any two ways by one of them.
fn pairwise() -> Vec<Decided> {
    let mut random = Random::new(1);
    let mut all: Vec<(f64, Decided)> = product(0..12).into_iter().map(|d| (random.signed(), d)).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut met = HashSet::new();
    let mut brings = |d: &Decided| {
        let pairs = (0..12).flat_map(|a| (0..a).map(move |b| (a, b)));
        pairs.filter(|&(a, b)| met.insert((a, b, d[a], d[b]))).count() > 0
    };
    all.into_iter().map(|(_, decided)| decided).filter(|decided| brings(decided)).collect()
}

/// What is composed here. All is too much: some 300,000 choices, and the resident kernel, which depends on everything, has a
/// different program for nearly every one, at some milliseconds each.
///
/// No other kernel depends on both what an element and what a node is made of ([`deciding`]). So in single precision every
/// element and every node is taken, in each place, with a partner that changes from one to the next: these kernels meet
/// the full product of what they depend on. The resident kernel meets every pair, and every node with the element that
/// binds most, and the node pass as pairs every node; the other precisions, which decide how numbers are written, meet every pair.
fn choices() -> Vec<(Decided, Kernel)> {
    let (elements, nodes) = (product(ELEMENT), product(NODE));
    assert!(nodes.len() >= elements.len(), "every element meets a node");
    let mut all: Vec<_> = pairwise().into_iter().flat_map(|d| Kernel::ALL.map(|k| (d, k))).collect();
    // Own classes, viscous, in a table.
    let binds_most = |node: &Decided| std::array::from_fn(|d| node[d] + usize::from(d == 4));
    all.extend(nodes.iter().map(|node| (binds_most(node), Kernel::Resident)));
    // The node pass binds most with positions as pairs.
    let pairs = PRECISIONS.iter().position(|p| p.has_pairs()).expect("f32+");
    let as_pairs = |node: &Decided| std::array::from_fn(|d| node[d] + if d == 11 { pairs } else { 0 });
    all.extend(nodes.iter().map(|node| (as_pairs(node), Kernel::Boundary)));
    for (shift, place) in product(PLACE).iter().enumerate() {
        for (k, node) in nodes.iter().enumerate() {
            let element = &elements[(k + shift) % elements.len()];
            let decided = std::array::from_fn(|d| element[d] + place[d] + node[d]);
            let apart = Kernel::ALL.into_iter().filter(|kernel| *kernel != Kernel::Resident);
            all.extend(apart.map(|kernel| (decided, kernel)));
        }
    }
    all
}

/// A composed program, and its text as naga reads it, before anything is dropped.
struct Composed {
    choice: Choice,
    kernel: Kernel,
    program: Program,
    module: Module,
}

/// Every different program, with a choice that makes it.
fn composed() -> &'static [Composed] {
    static ALL: LazyLock<Vec<Composed>> = LazyLock::new(|| {
        let (mut keys, mut texts) = (HashSet::new(), HashSet::new());
        let new = |(decided, kernel): (Decided, Kernel)| {
            let choice = choice(&decided);
            if !compiled(&choice, kernel)
                || is_like_others(&choice, kernel)
                || !keys.insert(key(kernel, &decided))
            {
                return None;
            }
            let program = compose(&choice, kernel);
            let module = parse(&program.text);
            texts.insert(program.text.clone()).then_some(Composed { choice, kernel, program, module })
        };
        choices().into_iter().filter_map(new).collect()
    });
    &ALL
}

/// Whether nothing is new in it. A Prony series asks of a law what viscosity asks, and no law or road asks where nodes and elements
/// stand: two laws, without I2 and with it, and one road stand for all there.
fn is_like_others(choice: &Choice, kernel: Kernel) -> bool {
    let decides = deciding(kernel);
    let seldom = !laws().take(2).any(|law| law == choice.law);
    let law = decides.contains(&LAW) && seldom && (choice.relaxes || choice.lattice);
    let other = choice.road.is_some_and(|road| road != ROADS[0]);
    law || (decides.contains(&ROAD) && other && choice.lattice)
}

fn compose(choice: &Choice, kernel: Kernel) -> Program {
    choice.compose(kernel).unwrap_or_else(|e| panic!("{kernel:?} of {choice:?}: {e}"))
}

/// A kernel depends on nothing but what [`deciding`] says: other choices that decide that alike make the same program.
#[test]
fn kernels_depend_on_what_decides_them() {
    let mut texts: HashMap<(Kernel, Vec<usize>), String> = HashMap::new();
    for decided in pairwise() {
        for kernel in Kernel::ALL {
            // Everything decides the resident kernel.
            if kernel == Kernel::Resident || !compiled(&choice(&decided), kernel) {
                continue;
            }
            let text = compose(&choice(&decided), kernel).text;
            let first = texts.entry(key(kernel, &decided)).or_insert_with(|| text.clone());
            assert_eq!(*first, text, "{kernel:?} depends on more than {:?}", deciding(kernel));
        }
    }
}

/// Every shipped scene, meshed, numbered and laid out as for real hardware: its programs in every stage and precision compose,
/// and in single precision those of the separate passes are among the programs of this file.
#[test]
fn programs_of_every_shipped_scene_compose_as_on_real_hardware() {
    let known: HashSet<&str> = composed().iter().map(|c| c.program.text.as_str()).collect();
    let (mut joined, mut wheels) = (0, 0);
    for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap();
        let scene = shipped(stem, &[""; 0]);
        let model = Model::new(&scene).unwrap();
        let ordered = order::ordered(&model);
        let chains = Chains::new(&ordered.model, chains::longest(false, model.element_count()), true);
        for precision in Precision::ALL {
            let of_scene = hexroll::gpu::choice(&ordered.model, &scene, &chains, precision);
            joined += usize::from(of_scene.joined);
            wheels += usize::from(stem.starts_with("lat100") && of_scene.joined && of_scene.lattice);
            for stage in &scene.stages {
                let free = stage.rim.drives().map(|d| match d {
                    Drive::Free { mass, .. } => Some(mass),
                    _ => None,
                });
                let choice = of_scene.for_stage(&StageSetup {
                    mass_damping: stage.mass_damping,
                    free,
                    relaxed: stage.is_quasi_static(),
                });
                for kernel in Kernel::ALL.into_iter().filter(|k| compiled(&choice, *k)) {
                    let text = compose(&choice, kernel).text;
                    let all_known = choice.road.is_none_or(|road| road == ROADS[0]);
                    let listed = precision != Precision::F32 || kernel == Kernel::Resident || !all_known;
                    assert!(listed || known.contains(text.as_str()), "{stem}: {kernel:?} of {choice:?}");
                }
            }
        }
    }
    assert!(joined > 40 && wheels >= 30, "{joined} scenes have joined chains, {wheels} of them wheels");
}

/// What an entry point reaches.
#[derive(Default)]
struct Reached {
    functions: BTreeSet<Handle<Function>>,
    globals: BTreeSet<Handle<GlobalVariable>>,
    overrides: BTreeSet<Handle<naga::Override>>,
}

impl Reached {
    fn from_entry(module: &Module) -> Reached {
        let mut reached = Reached::default();
        for entry in &module.entry_points {
            reached.function(module, &entry.function);
        }
        reached
    }

    fn function(&mut self, module: &Module, function: &Function) {
        self.expressions(module, function.expressions.iter().map(|(_, e)| e));
        self.block(module, &function.body);
    }

    fn expressions<'e>(&mut self, module: &Module, all: impl Iterator<Item = &'e Expression>) {
        for expression in all {
            match *expression {
                Expression::GlobalVariable(global) => {
                    self.globals.insert(global);
                    // A constant may be the length of an array.
                    let ty = module.global_variables[global].ty;
                    if let TypeInner::Array { size: ArraySize::Pending(length), .. } = module.types[ty].inner
                    {
                        self.overrides.insert(length);
                    }
                }
                Expression::Override(value) => drop(self.overrides.insert(value)),
                _ => {}
            }
        }
    }

    fn block(&mut self, module: &Module, block: &Block) {
        for statement in block {
            match statement {
                Statement::Call { function, .. } if self.functions.insert(*function) => {
                    self.function(module, &module.functions[*function]);
                }
                Statement::Block(inner) => self.block(module, inner),
                Statement::If { accept, reject, .. } => {
                    self.block(module, accept);
                    self.block(module, reject);
                }
                Statement::Loop { body, continuing, .. } => {
                    self.block(module, body);
                    self.block(module, continuing);
                }
                Statement::Switch { cases, .. } => cases.iter().for_each(|c| self.block(module, &c.body)),
                _ => {}
            }
        }
    }

    /// Names of what a module has and its entry point does not reach.
    fn missed(&self, module: &Module) -> BTreeSet<String> {
        let name = |n: &Option<String>| n.clone().expect("everything in our WGSL has a name");
        let functions = module.functions.iter().filter(|(h, _)| !self.functions.contains(h));
        let globals = module.global_variables.iter().filter(|(h, _)| !self.globals.contains(h));
        let overrides = module.overrides.iter().filter(|(h, _)| !self.overrides.contains(h));
        (functions.map(|(_, f)| name(&f.name)))
            .chain(globals.map(|(_, g)| name(&g.name)))
            .chain(overrides.map(|(_, o)| name(&o.name)))
            .collect()
    }
}

fn parse(text: &str) -> Module {
    naga::front::wgsl::parse_str(text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(text)))
}

/// Names of functions, variables and overrides that a part declares.
fn declared(part: &str) -> BTreeSet<String> {
    let (_, source) =
        PARTS.iter().find(|(name, _)| *name == part).unwrap_or_else(|| panic!("no part {part}"));
    let (_, all) = scan(source).unwrap();
    let text = |d: &hexroll::gpu::compose::scan::Declaration| {
        !d.text.contains("struct ") && !d.text.contains("alias ")
    };
    all.into_iter().filter(text).map(|d| d.name).collect()
}

/// Names in a composed module.
fn names(module: &Module) -> BTreeSet<String> {
    let functions = module.functions.iter().filter_map(|(_, f)| f.name.clone());
    let globals = module.global_variables.iter().filter_map(|(_, g)| g.name.clone());
    let overrides = module.overrides.iter().filter_map(|(_, o)| o.name.clone());
    functions.chain(globals).chain(overrides).collect()
}

#[test]
fn every_composition_is_valid_and_all_of_it_is_reached() {
    let all = composed();
    assert!((1500..6000).contains(&all.len()), "{} programs", all.len());
    for Composed { choice, kernel, program, .. } in all {
        assert_eq!(program.module.entry_points.len(), 1);
        let missed = Reached::from_entry(&program.module).missed(&program.module);
        assert!(missed.is_empty(), "{kernel:?} of {choice:?} has {missed:?} and does not use it");
    }
}

/// The closure over names brings what the entry point reaches and nothing else: naga finds nothing to drop.
#[test]
fn no_text_brings_what_its_kernel_does_not_use() {
    let mut all: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for Composed { kernel, module, .. } in composed() {
        all.entry(format!("{kernel:?}")).or_default().extend(Reached::from_entry(module).missed(module));
    }
    all.retain(|_, names| !names.is_empty());
    assert!(all.is_empty(), "brought and not used: {all:?}");
}

/// What `check --programs` writes is what runs: same names, same numbers, same access.
#[test]
fn the_text_of_a_program_says_what_runs() {
    let buffers = |module: &Module| -> BTreeSet<String> {
        let of = |g: &GlobalVariable| format!("{:?} {:?} {:?}", g.name, g.binding, g.space);
        module.global_variables.iter().map(|(_, g)| of(g)).collect()
    };
    for Composed { program, module, .. } in composed() {
        assert_eq!(names(module), names(&program.module));
        assert_eq!(buffers(module), buffers(&program.module));
    }
}

/// The walk sees what it must see: an unused function, a function used by an unused one only, an unused binding and
/// an unused override.
#[test]
fn an_unused_part_is_found() {
    let unused = "override spare: f32; @group(0) @binding(99) var<storage, read> lost: array<f32>;
        fn inner() -> f32 { return 1.0; } fn outer() -> f32 { return inner(); }";
    let module = parse(&format!("{}{unused}", composed()[0].program.text));
    let missed = Reached::from_entry(&module).missed(&module);
    for name in ["spare", "lost", "inner", "outer"] {
        assert!(missed.contains(name), "{name} was not found");
    }
}

/// Every declaration of every part that kernels may use is in some program.
#[test]
fn every_declaration_is_used_by_some_composition() {
    let mut idle: BTreeSet<(String, String)> = BTreeSet::new();
    for (part, text) in PARTS.iter().filter(|(part, _)| !part.starts_with("bench/")) {
        idle.extend(scan(text).unwrap().1.into_iter().map(|d| (part.to_string(), d.name)));
    }
    for Composed { program, .. } in composed() {
        for (part, text) in sections(&program.text) {
            scan(text).unwrap().1.into_iter().for_each(|d| {
                idle.remove(&(part.to_string(), d.name));
            });
        }
    }
    assert!(idle.is_empty(), "no kernel uses {idle:?}");
}

/// A program's text by the parts it is from.
fn sections(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.split("// ---- ").skip(1).map(|section| section.split_once('\n').unwrap())
}

/// A feature: its files, those that stand in for it, buffers that nothing else binds, and whether a choice has it.
struct Feature {
    name: &'static str,
    files: &'static [&'static str],
    instead: &'static [&'static str],
    buffers: &'static [&'static str],
    chosen: fn(&Choice) -> bool,
}

const FEATURES: [Feature; 18] = [
    Feature {
        name: "a Prony series",
        files: &["memory/prony"],
        instead: &["memory/none"],
        buffers: &[],
        chosen: |c| c.relaxes,
    },
    Feature {
        name: "friction",
        files: &[
            "friction/coulomb",
            "friction/viscous",
            "friction/stribeck",
            "friction/static_kinetic",
            "friction/pressure_velocity",
        ],
        instead: &[],
        buffers: &[],
        chosen: |c| c.friction.is_some(),
    },
    Feature {
        name: "Coulomb friction",
        files: &["friction/coulomb"],
        instead: &["friction/viscous"],
        buffers: &[],
        chosen: |c| matches!(c.friction, Some(Friction::Coulomb(_))),
    },
    Feature {
        name: "two coefficients of friction",
        files: &["friction/stribeck", "friction/static_kinetic"],
        instead: &["friction/viscous", "friction/pressure_velocity"],
        buffers: &[],
        chosen: |c| matches!(c.friction, Some(Friction::Stribeck(_) | Friction::StaticKinetic(_))),
    },
    Feature {
        name: "friction by pressure",
        files: &["friction/pressure_velocity"],
        instead: &["friction/viscous", "friction/stribeck"],
        buffers: &[],
        chosen: |c| c.friction.is_some_and(|law| law.needs_area()),
    },
    Feature {
        name: "held components",
        files: &["hold/components"],
        instead: &["hold/none"],
        buffers: &["held"],
        chosen: |c| c.held,
    },
    Feature {
        name: "contact",
        files: &["contact/project", "road/plane"],
        instead: &["contact/none"],
        buffers: &[],
        chosen: |c| c.road.is_some(),
    },
    Feature {
        name: "a drum",
        files: &["road/drum"],
        instead: &["road/plane", "road/disk", "road/wave", "road/profile", "road/height_field"],
        buffers: &[],
        chosen: |c| c.road == Some("drum"),
    },
    Feature {
        name: "a disk",
        files: &["road/disk"],
        instead: &["road/plane", "road/drum", "road/wave", "road/profile", "road/height_field"],
        buffers: &[],
        chosen: |c| c.road == Some("disk"),
    },
    Feature {
        name: "a cosine",
        files: &["road/wave"],
        instead: &["road/plane", "road/drum", "road/disk", "road/profile", "road/height_field"],
        buffers: &[],
        chosen: |c| c.road == Some("wave"),
    },
    Feature {
        name: "a profile",
        files: &["road/profile"],
        instead: &["road/plane", "road/drum", "road/disk", "road/wave", "road/height_field"],
        buffers: &[],
        chosen: |c| c.road == Some("profile"),
    },
    Feature {
        name: "a height field",
        files: &["road/height_field"],
        instead: &["road/plane", "road/drum", "road/disk", "road/wave", "road/profile"],
        buffers: &[],
        chosen: |c| c.road == Some("height-field"),
    },
    Feature {
        name: "viscosity",
        files: &["viscosity/kelvin_voigt", "force/points_viscous", "force/mean_viscous"],
        instead: &["viscosity/none", "force/points_elastic", "force/mean_elastic"],
        buffers: &[],
        chosen: |c| c.viscous,
    },
    Feature {
        name: "gravity",
        files: &["gravity/uniform"],
        instead: &["gravity/none"],
        buffers: &[],
        chosen: |c| c.gravity,
    },
    Feature {
        name: "damping",
        files: &["damping/mass"],
        instead: &["damping/none"],
        buffers: &[],
        chosen: |c| c.damping,
    },
    Feature {
        name: "rim",
        files: &["rim/carried", "pose/prescribed", "pose/free"],
        instead: &["rim/none"],
        buffers: &[],
        chosen: |c| c.rim != RimKind::None,
    },
    Feature {
        name: "pairs",
        files: &["position/pairs", "lib/two_sum"],
        instead: &["position/plain"],
        buffers: &[],
        chosen: |c| c.precision.has_pairs(),
    },
    Feature {
        name: "a lattice",
        files: &["chain/lattice", "gather/lattice"],
        instead: &["chain/table", "gather/table"],
        buffers: &[],
        chosen: |c| c.lattice,
    },
];

/// Kernels a choice compiles. The check of sums stands outside the scene, and only `f32+` runs it; the rim's own
/// kernel belongs to free rims.
fn compiled(choice: &Choice, kernel: Kernel) -> bool {
    match kernel {
        Kernel::CheckSums => choice.precision.has_pairs(),
        Kernel::Resident => {
            choice.precision == Precision::F32 && choice.rim != RimKind::Free && !choice.relaxes
        }
        Kernel::Rim => choice.rim == RimKind::Free,
        Kernel::Rebase => choice.rim != RimKind::None && choice.precision != Precision::F64,
        _ => true,
    }
}

#[test]
fn a_scene_without_a_feature_has_no_code_binding_or_constant_of_it() {
    for feature in &FEATURES {
        let of = |files: &[&str]| files.iter().flat_map(|f| declared(f)).collect::<BTreeSet<String>>();
        let mut own: BTreeSet<String> = of(feature.files).difference(&of(feature.instead)).cloned().collect();
        own.extend(feature.buffers.iter().map(|name| name.to_string()));
        assert!(!own.is_empty(), "{} has nothing of its own", feature.name);
        let mut present = BTreeSet::new();
        for Composed { choice, module, kernel, .. } in composed() {
            let found: BTreeSet<String> = names(module).intersection(&own).cloned().collect();
            if (feature.chosen)(choice) {
                present.extend(found);
            } else {
                assert!(found.is_empty(), "{kernel:?} without {} has {found:?}", feature.name);
            }
        }
        assert_eq!(present, own, "a scene with {} does not have all of it", feature.name);
    }
}

/// Memory layouts: what the host makes of a declaration is what naga makes of its WGSL.
#[test]
fn host_and_shader_agree_on_every_struct() {
    for (real, part) in [(Real::Single, "real/single"), (Real::Double, "real/double")] {
        let (_, aliases) = PARTS.iter().find(|(name, _)| *name == part).unwrap();
        agree(real, aliases);
    }
}

fn agree(real: Real, aliases: &str) {
    let shared = layout::all(real);
    let text: String = shared.iter().map(|s| s.text.as_str()).collect();
    let module = parse(&format!("{aliases}{text}"));
    assert!(shared.len() >= 9);
    for host in &shared {
        let (_, found) = (module.types.iter())
            .find(|(_, t)| t.name.as_deref() == Some(host.name))
            .unwrap_or_else(|| panic!("{} is not in the WGSL", host.name));
        let naga::TypeInner::Struct { members, span } = &found.inner else {
            panic!("{} is no struct", host.name)
        };
        assert_eq!(*span as usize, host.size, "size of {}", host.name);
        let offsets: Vec<(&str, usize)> =
            members.iter().map(|m| (m.name.as_deref().unwrap(), m.offset as usize)).collect();
        assert_eq!(offsets, host.offsets, "offsets in {}", host.name);
    }
}

/// A value comes back from its bytes, in single precision rounded, and takes the bytes that it says.
#[test]
fn a_struct_comes_back_from_its_bytes() {
    let third = 1.0 / 3.0;
    let record = layout::SurfaceRecord {
        impulse: [third, 2.0, 3.0, 4.0],
        normal_work: 5.0,
        friction_work: third,
        touching: 7,
        sticking: 8,
    };
    for (real, third) in [(Real::Single, f64::from(third as f32)), (Real::Double, third)] {
        let bytes = layout::encode(real, &[record; 3]);
        assert_eq!(bytes.len(), 3 * layout::SurfaceRecord::size(real));
        let impulse = [third, 2.0, 3.0, 4.0];
        let expected = layout::SurfaceRecord { impulse, friction_work: third, ..record };
        assert_eq!(layout::decode::<layout::SurfaceRecord>(real, &bytes), [expected; 3]);
    }
    // Padding within and behind: a vector of three numbers is as far from the next as one of four.
    assert_eq!(layout::encode(Real::Double, &[[1.0; 3]; 2]).len(), 64);
}

/// A road that scenes know and shaders do not is an error that names the file.
#[test]
fn a_variant_without_a_file_is_named() {
    let choice = Choice { road: Some("washboard-road"), ..choice(&[0; 12]) };
    let error = choice.compose(Kernel::Boundary).unwrap_err().to_string();
    assert!(error.contains("kernels/node") && error.contains("shaders/road/washboard_road.wgsl"), "{error}");
}

/// Bindings are numbered from 0 without gaps, and the device is asked for as many as the largest kernel has.
#[test]
fn the_largest_kernel_binds_what_adapters_are_asked_for() {
    let (mut most, mut resident) = (0, 0);
    for Composed { choice, kernel, program, .. } in composed() {
        let bindings = hexroll::gpu::bindings::bindings(&program.module);
        let indices: Vec<u32> = bindings.iter().map(|b| b.index).collect();
        let dense: Vec<u32> = (0..bindings.len() as u32).collect();
        assert_eq!(indices, dense, "{kernel:?} of {choice:?}");
        let access = |b: &&hexroll::gpu::bindings::Binding| {
            b.kind == hexroll::gpu::bindings::BindingKind::Storage { writes: true } && !b.written
        };
        let idle: Vec<&str> = bindings.iter().filter(access).map(|b| b.name.as_str()).collect();
        assert!(idle.is_empty(), "{kernel:?} of {choice:?} binds {idle:?} for writing and only reads them");
        let storage = |b: &&hexroll::gpu::bindings::Binding| {
            matches!(b.kind, hexroll::gpu::bindings::BindingKind::Storage { .. })
        };
        let most = if *kernel == Kernel::Resident { &mut resident } else { &mut most };
        *most = bindings.iter().filter(storage).count().max(*most);
    }
    assert_eq!(most, hexroll::gpu::STORAGE_BUFFERS as usize);
    assert_eq!(resident, hexroll::gpu::RESIDENT_STORAGE_BUFFERS as usize);
}

/// Dispatches fold into two dimensions; every item is met exactly once, whatever the adapter's limit.
#[test]
fn a_folded_dispatch_meets_every_item_once() {
    // Sizes around every fold, with the index that shaders/lib/index.wgsl computes.
    for most_groups in [1, 2, 3, 7] {
        let counts = Counts {
            terms: 0,
            remembered: 0,
            elements: 0,
            nodes: 0,
            surface: 0,
            rim: 0,
            chain_groups: 0,
            slots: 0,
            stored_slots: 0,
            most_groups,
        };
        for items in (1..400).chain([64 * 63, 64 * 64, 64 * 65 + 1]) {
            let [columns, rows, depth] = counts.groups(items);
            if rows > most_groups {
                // Beyond two dimensions: far more memory than any adapter has; see the next test for real limits.
                continue;
            }
            assert!(columns <= most_groups && depth == 1);
            let mut met: BTreeMap<u32, u32> = BTreeMap::new();
            for row in 0..rows {
                for column in 0..columns {
                    for lane in 0..64 {
                        *met.entry((row * columns + column) * 64 + lane).or_default() += 1;
                    }
                }
            }
            assert!(
                (0..items as u32).all(|i| met.get(&i) == Some(&1)),
                "{items} items, {most_groups} groups"
            );
        }
    }
}

#[test]
fn a_dispatch_beyond_one_dimension_is_folded() {
    let counts = Counts {
        terms: 0,
        remembered: 0,
        elements: 0,
        nodes: 0,
        surface: 0,
        rim: 0,
        chain_groups: 0,
        slots: 0,
        stored_slots: 0,
        most_groups: 65_535,
    };
    let dimension = 65_535 * 64;
    assert_eq!(counts.groups(dimension), [65_535, 1, 1]);
    for items in [dimension + 1, 2 * dimension, 2 * dimension + 1, 100_000_000, u32::MAX as usize] {
        let groups = counts.groups(items);
        let threads = groups.map(u64::from).iter().product::<u64>() * 64;
        assert!(groups.iter().all(|&g| g <= 65_535), "{groups:?}");
        assert!(threads >= items as u64, "{groups:?} for {items}");
        // Fewer idle groups than rows.
        assert!(threads - (items as u64) < 64 * (u64::from(groups[1]) + 1), "{groups:?} for {items}");
    }
}
