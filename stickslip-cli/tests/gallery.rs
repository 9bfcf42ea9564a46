//! The gallery as its user meets it: listed, shown, run. `./check --all` runs every scene of it.

mod stickslip;

use std::fs;
use stickslip::Workplace;

#[test]
fn scenes_are_listed_and_shown() {
    let workplace = Workplace::new();
    let list = workplace.succeed(&["gallery"]);
    assert!(list.contains("taylor_bar") && list.contains("final length [mm], 21.2 to 21.6"), "{list}");
    assert_eq!(list, workplace.succeed(&["gallery", "list"]));
    let shown = workplace.succeed(&["gallery", "show", "taylor_bar"]);
    assert!(shown.starts_with("title = \"Taylor's bar"), "{shown}");
    let unknown = workplace.run(&["gallery", "show", "taylors_bar"]);
    assert!(unknown.code == Some(2) && unknown.stderr.contains("taylor_bar"), "{}", unknown.stderr);
}

#[test]
fn a_scene_is_run_drawn_and_checked() {
    let workplace = Workplace::new();
    let said = workplace.succeed(&["gallery", "run", "wheel", "--out", "here"]);
    assert!(said.contains("allowed 0.97 to 1.03: holds"), "{said}");
    let file = |name: &str| workplace.path("here").join(name);
    assert_eq!(&fs::read(file("wheel/picture.png")).unwrap()[1..4], b"PNG");
    assert_eq!(&fs::read(file("wheel/animation.gif")).unwrap()[..4], b"GIF8");

    // Pictures of bodies in space need the scene's file for their surfaces.
    let record = fs::read_to_string(file("wheel/run.json")).unwrap();
    assert!(record.contains("scenes/wheel.toml"), "where the scene came from");

    // A scene that fails does not hide those after it.
    fs::create_dir(file("penetration")).unwrap();
    fs::write(file("penetration/thesis.tex"), "years of work").unwrap();
    let both = workplace.run(&["gallery", "run", "penetration", "wheel", "--out", "here"]);
    assert!(both.code == Some(1) && both.stdout.contains("wheel: energy"), "{}{}", both.stdout, both.stderr);
    assert!(both.stderr.contains("thesis.tex"), "{}", both.stderr);
    assert!(both.stderr.ends_with("error: these scenes failed: penetration\n"), "{}", both.stderr);

    // Results that are there stand, and what they say is looked at again.
    let energy = fs::read_to_string(file("wheel/energy.csv")).unwrap();
    let less: Vec<&str> = energy.lines().take(30).collect();
    fs::write(file("wheel/energy.csv"), less.join("\n") + "\n").unwrap();
    let cut = workplace.run(&["gallery", "run", "wheel", "--out", "here"]);
    assert!(cut.code == Some(2) && cut.stderr.contains("it was cut"), "{}", cut.stderr);

    // A file of the user's is not written over.
    fs::write(file("scenes/wheel.toml"), "mine").unwrap();
    let refused = workplace.run(&["gallery", "run", "wheel", "--out", "here"]);
    assert!(refused.code == Some(2) && refused.stderr.contains("is another"), "{}", refused.stderr);
    assert_eq!(fs::read_to_string(file("scenes/wheel.toml")).unwrap(), "mine");
}
