use super::*;

fn turned_box() -> Shape {
    Shape::cuboid([0.0; 3], [1.0, 0.8, 0.6]).rotated([0.3, 0.1, 0.0], [0.0, 0.0, 1.0], 0.4)
}

fn check<const D: usize>(shape: &Shape, cell: f64) -> Form<D> {
    let form = Form::<D>::new(shape, cell, HeldFaces::default()).unwrap();
    let moments = shape.moments(D).unwrap();
    let volume: f64 = form.volumes.iter().sum();
    assert!((volume / moments.volume - 1.0).abs() < 1e-12, "{volume} for {}", moments.volume);
    let masses: f64 = form.node_volumes.iter().sum();
    assert!((masses / moments.volume - 1.0).abs() < 1e-9, "{masses}");
    let offsets = &form.offsets;
    // Functions sum to one, and places follow from those of the nodes, by masters alone as well.
    for place in &form.places {
        let weights = form.weights(*place);
        let (mut sum, mut at, mut slopes) = (0.0, Vector::<f64, D>::ZERO, [[0.0; D]; D]);
        weights.each(|k, value, slope| {
            let x = form.node_place(weights.node + offsets[k] as usize);
            sum += value;
            at += x * value;
            let slope = form.frame.turned(slope);
            (0..D).for_each(|i| (0..D).for_each(|j| slopes[i][j] += x[i] * slope[j] / cell));
        });
        assert!((sum - 1.0).abs() < 1e-13 && (at - *place).norm() < 1e-12);
        (0..D).for_each(|i| {
            (0..D).for_each(|j| assert!((slopes[i][j] - f64::from(u8::from(i == j))).abs() < 1e-11))
        });
    }
    for (node, masters, shares) in form.followers.iter() {
        let place = masters.iter().zip(shares).fold(Vector::<f64, D>::ZERO, |sum, (&m, &e)| {
            assert!(form.node_volumes[m as usize] > 0.0, "a master leads");
            sum + form.node_place(m as usize) * e
        });
        assert!((place - form.node_place(node)).norm() < 1e-9 * cell.max(1.0), "{place:?}");
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    }
    // Centre and inertia of the masters are those of the shape.
    let mean = (0..form.nodes()).fold(Vector::<f64, D>::ZERO, |sum, node| {
        sum + form.node_place(node) * (form.node_volumes[node] / moments.volume)
    });
    assert!((mean - Vector::of(moments.center)).norm() < 1e-9, "{mean:?} for {:?}", moments.center);
    for i in 0..D {
        let spread =
            |node: usize| (form.node_place(node)[i] - moments.center[i]).powi(2) * form.node_volumes[node];
        let second: f64 = (0..form.nodes()).map(spread).sum();
        assert!(
            (second / moments.second.0[i][i] - 1.0).abs() < 1e-9,
            "{second} for {}",
            moments.second.0[i][i]
        );
    }
    form
}

#[test]
fn disks_and_boxes_have_their_mass_and_inertia() {
    check::<2>(&Shape::disk([0.3, -0.2], 1.0), 0.25);
    check::<2>(&Shape::disk([0.3, -0.2], 1.0), 0.13);
    let form = check::<2>(&Shape::rectangle([0.0, 0.0], [1.0, 0.5]), 0.125);
    assert_eq!(form.places.len(), 16 * 8, "a box of whole cells has whole parts only");
    check::<2>(&turned_box(), 0.1);
}

#[test]
fn so_do_solids_in_space() {
    check::<3>(&Shape::ball([0.1, 0.2, 0.3], 1.0), 0.25);
    check::<3>(&turned_box(), 0.1);
}

#[test]
fn shapes_without_room_for_two_cells_have_no_grid() {
    let thin = Shape::rectangle([0.0, 0.0], [1.0, 0.15]);
    assert_eq!(Form::<2>::new(&thin, 0.1, HeldFaces::default()).unwrap_err(), NoForm::Thin(0.15));
    assert_eq!(
        Form::<2>::new(&Shape::half_space([0.0; 3], [0.0, 1.0, 0.0]), 0.1, HeldFaces::default()).unwrap_err(),
        NoForm::Unbounded
    );
}
