//! The packer as a program.

use std::process::Command;

#[test]
fn what_is_wrong_is_named_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, gone) = (folder.path().join("out"), folder.path().join("gone"));
    let [out_text, gone_text] = [&out, &gone].map(|path| path.to_str().expect("a name in UTF-8"));
    for (arguments, words) in [
        (vec![], "--out is missing"),
        (vec!["--out"], "--out needs a value"),
        (vec!["--out", out_text, "--colour", "blue"], "--colour is unknown"),
        (vec!["--out", out_text, "--program", gone_text], gone_text),
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_lightloom_package")).args(&arguments).output();
        let output = output.expect("the packer starts");
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(told.contains(words), "{arguments:?}: {told}");
        assert!(!out.exists(), "{arguments:?}");
    }
}
