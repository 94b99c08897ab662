//! The paper's wheel pressed on the road.

use super::fixtures::*;
use hexroll::implicit::Scheme;
use hexroll::scene::Element;

#[test]
fn pressed_by_2_2_mm_the_wheel_carries_300_newtons() {
    for (mu, force, nodes) in [(1.0, 300.3, 22), (0.0, 283.9, 26)] {
        let model = wheel([44, 4, 5], Element::Q1p0);
        let mut s = simulation(&model, Scheme::Static, Some(road(mu)));
        let steps = 10;
        for n in 1..=steps {
            let down = -2.2e-3 * n as f64 / steps as f64;
            let t0 = std::time::Instant::now();
            let log = s.step(&held(&model, n as f64, 1.0, [0.0, 0.0, down, 0.0, 0.0, 0.0])).unwrap();
            println!("{:?}", t0.elapsed());
            let residuals: Vec<String> =
                log.iter().map(|i| format!("{:.1e}/{}/{}", i.residual, i.changes, i.share)).collect();
            println!("{:.2} mm: {} -> {:?}", 1e3 * down, residuals.join(" "), road_force(&s));
            assert!(log.len() <= 11, "{} iterations", log.len() - 1);
        }
        let (f, touching) = road_force(&s);
        // The bound; another program's number has four digits.
        assert!((f[2] / force - 1.0).abs() < 0.005, "mu = {mu}: {} N", f[2]);
        assert_eq!(touching, nodes);
    }
}
