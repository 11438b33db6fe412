//! Files of points.

use lightloom_core::targets::load_points;

use super::seeds::npy;
use super::{Row, told};

fn read(bytes: &[u8]) -> Result<Vec<String>, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points");
    std::fs::write(&path, bytes).unwrap();
    load_points(&path).map(|_| Vec::new()).map_err(|error| told(error, folder.path()))
}

/// A header with its length, and data.
fn raw(header: &str, data: &[u8]) -> Vec<u8> {
    let length = (header.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\0".as_slice(), &length, header.as_bytes(), data].concat()
}

pub(super) fn rows() -> Vec<Row> {
    let good = npy(&[2, 2], &[0.25, 0.75, 0.5, 0.5]);
    let dict = |descr: &str, shape: &str| {
        format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}\n")
    };
    let refused: Vec<(&str, Vec<u8>, &str)> = vec![
        ("an empty file", Vec::new(), "points … there are no points"),
        ("names alone", b"x,y\n".to_vec(), "there are no points"),
        (
            "a word for a number",
            b"x,y\n0.5,0.5\n0.5,half\n".to_vec(),
            "line 3 … not all its fields are numbers",
        ),
        ("NaN", b"0.5,nan\n".to_vec(), "line 1 … NaN"),
        ("infinity", b"0.5,inf\n".to_vec(), "line 1 … infinite"),
        ("1e400", b"0.5,1e400\n".to_vec(), "line 1 … infinite"),
        ("three numbers", b"0.5,0.5,0.5\n".to_vec(), "line 1 … x, y, r, g, b"),
        ("a negative colour", b"0.5,0.5,1,-1,0\n".to_vec(), "line 1 … negative"),
        ("black alone", b"0.5,0.5,0,0,0\n".to_vec(), "all points are black"),
        ("no text", b"0.5,\xff\xfe\n".to_vec(), "neither NPY nor UTF-8"),
        ("NPY cut off in its data", good[..good.len() - 3].to_vec(), "cut short"),
        ("NPY cut off in its header", good[..20].to_vec(), "NPY header"),
        (
            "NPY of version 9",
            raw("", b"").into_iter().enumerate().map(|(i, b)| if i == 6 { 9 } else { b }).collect(),
            "version",
        ),
        ("NPY of objects", raw(&dict("'|O'", "(2, 2)"), &[0; 32]), "f32 or f64"),
        (
            "NPY of 2^64 - 1 rows",
            raw(&dict("'<f4'", "(18446744073709551615, 2)"), &[]),
            "more than 10000000 points",
        ),
        (
            "NPY of 9 999 999 rows without data",
            raw(&dict("'<f4'", "(9999999, 2)"), &[]),
            "cut short … 79999992",
        ),
        ("NPY of three axes", npy(&[1, 2, 2], &[0.5; 4]), "n x 2"),
        ("NPY with NaN", npy(&[2, 2], &[0.5, 0.5, f32::NAN, 0.5]), "row 1 … NaN"),
    ];
    let read_rows: Vec<(&str, &[u8])> = vec![
        ("a byte order mark", b"\xef\xbb\xbfx,y\n0.5,0.5\n"),
        ("CRLF", b"x,y\r\n0.5,0.5\r\n"),
        ("decimal commas between semicolons", b"0,5;0,25\n"),
        ("comments and empty lines", b"# made by hand\n\n0.5 0.5\n"),
    ];
    let refused =
        refused.into_iter().map(|(input, bytes, words)| Row::refused(input, words, || read(&bytes)));
    let read_rows = read_rows.into_iter().map(|(input, bytes)| Row::read(input, "", || read(bytes)));
    refused.chain(read_rows).collect()
}
