//! Point files: decimal commas, and arrays in any order.

use glam::{Vec2, vec2};
use lightloom_core::files::npy::NpyWriter;
use lightloom_core::targets::{Points, load_points};

fn load(content: &[u8]) -> Result<Points, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points");
    std::fs::write(&path, content).unwrap();
    load_points(&path).map_err(|error| error.to_string())
}

const EXPECTED: [Vec2; 3] = [vec2(0.25, 0.75), vec2(0.5, 0.5), vec2(1.0, 0.125)];

#[test]
fn numbers_with_decimal_commas_are_read_where_other_separators_tell_them_apart() {
    for text in [
        "x,y\n0.25,0.75\n0.5,0.5\n1,0.125\n",
        "x;y\n0,25;0,75\n0,5;0,5\n1;0,125\n",
        "x; y\r\n0,25; 0,75\r\n0,5; 0,5\r\n1; 0,125\r\n",
        "0,25\t0,75\n0,5\t0,5\n1\t0,125\n",
        "0,25 0,75\n0,5 0,5\n1 0,125\n",
        "x,y\r0.25,0.75\r0.5,0.5\r1,0.125\r",
        "0.25, 0.75\n0.5, 0.5\n1, 0.125\n",
        "0.25;0.75\n0.5;0.5\n1;0.125\n",
    ] {
        assert_eq!(load(text.as_bytes()).unwrap().positions, EXPECTED, "{text}");
    }
    let coloured = load(b"0,25;0,75;1;0,5;0\n0,5;0,5;1;0,5;0\n").unwrap();
    assert_eq!((coloured.positions.len(), coloured.colours.len()), (2, 2));
    // Three columns are no points, with points or with commas.
    for text in ["x;y;z\n0,25;0,75;1\n0,5;0,5;1\n", "0.25,0.75,1\n", "0,25,0,75\n", "1.000,5;2\n"] {
        assert!(load(text.as_bytes()).is_err(), "{text}");
    }
}

/// An array as NumPy stores it.
fn npy(shape: &[u64], fortran_order: bool, values: &[f32]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut writer = NpyWriter::new(&mut file, shape).unwrap();
    writer.extend(values.iter().copied()).unwrap();
    writer.finish().unwrap();
    if fortran_order {
        // Of the same length, so that the header stays aligned.
        let at = file.windows(5).position(|word| word == b"False").unwrap();
        file.splice(at..at + 5, *b"True ");
    }
    file
}

#[test]
fn arrays_are_read_by_rows_and_by_columns() {
    let by_point = [0.25, 0.75, 0.5, 0.5, 1.0, 0.125];
    let by_column = [0.25, 0.5, 1.0, 0.75, 0.5, 0.125];
    for (shape, fortran_order, values) in [
        ([3, 2], false, by_point),
        // np.array([x, y]).T
        ([3, 2], true, by_column),
        // np.array([x, y])
        ([2, 3], false, by_column),
        ([2, 3], true, by_point),
    ] {
        let points = load(&npy(&shape, fortran_order, &values)).unwrap();
        assert_eq!(points.positions, EXPECTED, "{shape:?} {fortran_order}");
    }
    // Of two points, rows are points.
    let square = load(&npy(&[2, 2], false, &[0.25, 0.75, 0.5, 0.5])).unwrap();
    assert_eq!(square.positions, EXPECTED[..2]);
    let coloured =
        load(&npy(&[5, 3], false, &[0.25, 0.5, 1.0, 0.75, 0.5, 0.125, 1., 1., 1., 0., 0., 0., 0., 0., 0.]));
    let coloured = coloured.unwrap();
    assert_eq!(coloured.positions, EXPECTED);
    assert!(coloured.colours.iter().all(|colour| colour.y == 0.0 && colour.x > 0.0));
    for (shape, count) in [(&[3, 3][..], 9), (&[6], 6), (&[1, 3, 2], 6)] {
        let error = load(&npy(shape, false, &vec![0.5; count])).unwrap_err();
        assert!(error.contains("n x 2"), "{error}");
    }
}
