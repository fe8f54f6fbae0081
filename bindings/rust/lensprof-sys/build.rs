//! Finds liblensprof: in the folder LENSPROF_LIB_DIR, else through pkg-config, else on the linker's own path.
use std::env;
use std::process::Command;

fn pkg_config(option: &str) -> Option<String> {
    let output = Command::new("pkg-config").args([option, "lensprof"]).output().ok()?;
    output
        .status
        .success()
        .then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

fn main() {
    println!("cargo:rerun-if-env-changed=LENSPROF_LIB_DIR");
    println!("cargo:rerun-if-env-changed=PKG_CONFIG_PATH");
    let folder = env::var("LENSPROF_LIB_DIR")
        .ok()
        .or_else(|| pkg_config("--variable=libdir"));
    if let Some(folder) = folder.filter(|folder| !folder.is_empty()) {
        println!("cargo:rustc-link-search=native={folder}");
    }
}
