//! Every kernel holds what its scene uses and nothing else. Proved on the composed text, without an adapter.
//!
//! The parts that decide a kernel's text are few: all combinations of 3 elements, 3 laws, 3 rims, road and friction law,
//! viscosity, gravity, damping, held components and precision give some 2,000 different texts, and every one of them
//! is checked.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::sync::LazyLock;

use hexroll::gpu::compose::scan::scan;
use hexroll::gpu::compose::{Choice, Composed as Program, Kernel, PARTS, RimKind};
use hexroll::gpu::layout::{self, Real, Wgsl};
use hexroll::gpu::{Counts, Precision};
use hexroll::scene::{Element, Friction, Law};
use naga::{ArraySize, Block, Expression, Function, GlobalVariable, Handle, Module, Statement, TypeInner};

/// Road, friction, held components: no road, and every road and every friction law with another of the others.
fn roads() -> Vec<(Option<&'static str>, Option<Friction>, bool)> {
    let frictions = Friction::KINDS.iter().map(|kind| Some((kind.example)()));
    let with_road = std::iter::once(None).chain(frictions).enumerate();
    let named =
        |(k, friction): (usize, Option<Friction>)| (Some(ROADS[k % ROADS.len()]), friction, k % 3 == 2);
    std::iter::once((None, None, false)).chain(with_road.map(named)).collect()
}

/// Roads by their names in scene files.
const ROADS: [&str; 2] = ["plane", "drum"];

fn choices() -> Vec<Choice> {
    let elements = [Element::Q1p0, Element::Full, Element::UniformGradient { hourglass: 0.15 }];
    let laws: Vec<Law> = Law::KINDS.iter().map(|kind| (kind.example)(1.0, 10.0)).collect();
    let mut all = Vec::new();
    for element in elements {
        for &law in &laws {
            for rim in [RimKind::None, RimKind::Prescribed, RimKind::Free] {
                for (road, friction, held) in roads() {
                    for (bits, precision) in (0..8).flat_map(|b| Precision::ALL.map(|p| (b, p))) {
                        let bit = |k: u32| bits >> k & 1 == 1;
                        let (viscous, gravity, damping) = (bit(0), bit(1), bit(2));
                        // Double precision has all of what single has: with none of these, and with all.
                        if precision == Precision::F64 && !(bits == 0 || bits == 7) {
                            continue;
                        }
                        let choice = Choice {
                            element,
                            law,
                            viscous,
                            road,
                            friction,
                            held,
                            gravity,
                            damping,
                            rim,
                            precision,
                            // Both, each with everything else.
                            extruded: gravity,
                            shared_classes: gravity,
                            lattice: damping,
                            joined: damping && gravity,
                        };
                        all.push(choice);
                    }
                }
            }
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
        let mut seen = HashSet::new();
        let all = choices().into_iter().flat_map(|c| Kernel::ALL.map(|k| (c, k)));
        let new = |(choice, kernel): (Choice, Kernel)| {
            let named = |e: hexroll::Error| -> Program { panic!("{kernel:?} of {choice:?}: {e}") };
            if !compiled(&choice, kernel) || !seen.insert(choice.draft(kernel).expect("names are there")) {
                return None;
            }
            let program = choice.compose(kernel).unwrap_or_else(named);
            let module = parse(&program.text);
            Some(Composed { choice, kernel, program, module })
        };
        all.filter_map(new).collect()
    });
    &ALL
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
    assert!((150..3000).contains(&all.len()), "{} programs", all.len());
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

/// A feature: its files, those that stand in for it, and whether a choice has it.
struct Feature {
    name: &'static str,
    files: &'static [&'static str],
    instead: &'static [&'static str],
    chosen: fn(&Choice) -> bool,
}

const FEATURES: [Feature; 12] = [
    Feature {
        name: "friction",
        files: &["friction/coulomb", "friction/viscous", "friction/stribeck", "friction/pressure_velocity"],
        instead: &[],
        chosen: |c| c.friction.is_some(),
    },
    Feature {
        name: "Coulomb friction",
        files: &["friction/coulomb"],
        instead: &["friction/viscous"],
        chosen: |c| matches!(c.friction, Some(Friction::Coulomb(_))),
    },
    Feature {
        name: "Stribeck friction",
        files: &["friction/stribeck"],
        instead: &["friction/viscous", "friction/pressure_velocity"],
        chosen: |c| matches!(c.friction, Some(Friction::Stribeck(_))),
    },
    Feature {
        name: "friction by pressure",
        files: &["friction/pressure_velocity"],
        instead: &["friction/viscous", "friction/stribeck"],
        chosen: |c| c.friction.is_some_and(|law| law.needs_area()),
    },
    Feature {
        name: "held components",
        files: &["hold/components"],
        instead: &["hold/none"],
        chosen: |c| c.held,
    },
    Feature {
        name: "contact",
        files: &["contact/project", "road/plane"],
        instead: &["contact/none"],
        chosen: |c| c.road.is_some(),
    },
    Feature {
        name: "viscosity",
        files: &["viscosity/kelvin_voigt", "force/points_viscous", "force/mean_viscous"],
        instead: &["viscosity/none", "force/points_elastic", "force/mean_elastic"],
        chosen: |c| c.viscous,
    },
    Feature {
        name: "gravity",
        files: &["gravity/uniform"],
        instead: &["gravity/none"],
        chosen: |c| c.gravity,
    },
    Feature { name: "damping", files: &["damping/mass"], instead: &["damping/none"], chosen: |c| c.damping },
    Feature {
        name: "rim",
        files: &["rim/carried", "pose/prescribed", "pose/free"],
        instead: &["rim/none"],
        chosen: |c| c.rim != RimKind::None,
    },
    Feature {
        name: "pairs",
        files: &["position/pairs", "lib/two_sum"],
        instead: &["position/plain"],
        chosen: |c| c.precision.has_pairs(),
    },
    Feature {
        name: "a lattice",
        files: &["chain/lattice", "gather/lattice"],
        instead: &["chain/table", "gather/table"],
        chosen: |c| c.lattice,
    },
];

/// Kernels a choice compiles. The check of sums stands outside the scene, and only `f32+` runs it; the rim's own
/// kernel belongs to free rims.
fn compiled(choice: &Choice, kernel: Kernel) -> bool {
    match kernel {
        Kernel::CheckSums => choice.precision.has_pairs(),
        Kernel::Resident => choice.precision == Precision::F32 && choice.rim != RimKind::Free,
        Kernel::Rim => choice.rim == RimKind::Free,
        Kernel::Rebase => choice.rim != RimKind::None && choice.precision != Precision::F64,
        _ => true,
    }
}

#[test]
fn a_scene_without_a_feature_has_no_code_binding_or_constant_of_it() {
    for feature in &FEATURES {
        let of = |files: &[&str]| files.iter().flat_map(|f| declared(f)).collect::<BTreeSet<String>>();
        let own: BTreeSet<String> = of(feature.files).difference(&of(feature.instead)).cloned().collect();
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
    let choice = Choice { road: Some("washboard-road"), ..choices()[0] };
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
