//! The hash names what a scene says, not how it is typed.

use hexroll::scene::Scene;

use crate::{GOOD, good};

#[test]
fn comments_order_and_spacing_do_not_change_the_hash_but_values_do() {
    let hash = good(&[]).unwrap().hash;
    assert_eq!(hash.len(), 64);
    assert!(hash.chars().all(|c| c.is_ascii_hexdigit() && !c.is_ascii_uppercase()));
    let typed = GOOD.replace("safety = 0.8", "safety   =   0.80 # a comment");
    assert_eq!(Scene::parse(&typed, "other.toml", &[]).unwrap().hash, hash);
    let swapped =
        GOOD.replace("title = \"a wheel\"\nsource = \"none\"", "source = \"none\"\ntitle = \"a wheel\"");
    assert_eq!(Scene::parse(&swapped, "other.toml", &[]).unwrap().hash, hash);
    assert_eq!(good(&["time_step.safety=0.8"]).unwrap().hash, hash);
    assert_ne!(good(&["time_step.safety=0.81"]).unwrap().hash, hash);
}

#[test]
fn the_effective_text_reads_back_as_the_same_scene() {
    let overrides = ["body.mesh.elements=[16, 3, 2]".to_string(), "stage.1.rim.x.velocity=3 m/s".to_string()];
    let scene = Scene::parse(GOOD, "good.toml", &overrides).unwrap();
    let text = Scene::effective_text(GOOD, "good.toml", &overrides).unwrap();
    assert_eq!(Scene::parse(&text, "good.toml", &[]).unwrap(), scene);
}
