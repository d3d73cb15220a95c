//! Bodies that a shape cannot fill: the scene says which body, and what of its shape.
//! What a lattice makes of a shape is tested with the shapes.

use meshfree::geometry::{Ball, Shape};
use meshfree::material::catalogue;
use meshfree::scene::{Body, Scene};
use meshfree::schemes;

#[test]
fn a_scene_reports_what_a_body_could_not_be_filled_with() {
    let problems = |shape: &dyn Shape<2>, spacing: f64| {
        let scene = Scene::<f64, 2>::new(schemes::impact());
        let body = Body::fill("drop", catalogue::water(), shape, spacing);
        let problems = scene.body(body).problems();
        let texts: Vec<_> = problems.iter().map(ToString::to_string).collect();
        texts.join("\n")
    };
    let disc = Ball::new([0.0; 2], 1.0);
    assert_eq!(
        problems(&Ball::new([0.0; 2], -1.0), 0.1),
        "radius of the ball of body `drop` is -1: it must be finite and positive, in metres"
    );
    assert_eq!(
        problems(&disc.complement(), 0.1),
        "extent of the shape of body `drop` is inf: it must be finite along every axis: intersect \
         the shape with a box"
    );
    let spacing = problems(&disc, f64::NAN);
    assert!(
        spacing.starts_with("spacing of body `drop` is NaN"),
        "{spacing}"
    );
    let many = problems(&disc, 1e-9);
    assert!(
        many.contains("check that the spacing is in metres"),
        "{many}"
    );
    let none = problems(&Ball::new([0.05; 2], 0.04), 0.2);
    assert!(none.contains("`drop` has no particles"), "{none}");
}
