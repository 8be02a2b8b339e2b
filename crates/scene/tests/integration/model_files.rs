//! Files that models name, with the small format of the tests of models.

use super::models::LOADER;
use std::collections::BTreeSet;
use std::fs;

#[cfg(unix)]
#[test]
fn files_of_a_model_lie_in_its_folder_even_through_symbolic_links() {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir().unwrap();
    let [inner, outside] = ["inner", "outside"].map(|name| folder.path().join(name));
    fs::create_dir_all(inner.join("deep")).unwrap();
    fs::create_dir(&outside).unwrap();
    fs::write(outside.join("secret.bin"), "1").unwrap();
    fs::write(inner.join("deep/plain.bin"), "2").unwrap();
    symlink("deep/plain.bin", inner.join("inside.bin")).unwrap();
    symlink("../outside/secret.bin", inner.join("link.bin")).unwrap();
    symlink(&outside, inner.join("folder")).unwrap();
    symlink("nowhere", inner.join("dangling.bin")).unwrap();
    symlink(&inner, folder.path().join("other")).unwrap();
    let path = folder.path().join("other/a.toy");
    let load = |name: &str| {
        fs::write(&path, format!("toy\n{name}\n")).unwrap();
        LOADER.load(&path).map(drop).map_err(|error| error.to_string())
    };
    for name in ["deep/plain.bin", "inside.bin", "deep/../inside.bin"] {
        assert_eq!(load(name), Ok(()), "{name}");
    }
    for name in ["link.bin", "folder/secret.bin"] {
        let message = load(name).unwrap_err();
        assert!(
            message.contains(&format!("{name}: a symbolic link leads out of the folder of the model")),
            "{message}"
        );
    }
    assert!(load("dangling.bin").unwrap_err().contains("no such file"));
}

#[test]
fn fingerprints_name_the_file_of_a_model_that_changed() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    let models = ["car/a.toy", "car/a.toy", "bus/a.toy"].map(|file| format!(r#"{{"model": {{"file": "{file}"}}}}"#));
    write("a.json", &format!(r#"{{"version": 1, "objects": [{}]}}"#, models.join(", ")));
    write("car/a.toy", "toy\nclip\npaint/wood.bin\n");
    write("car/paint/wood.bin", "1");
    write("bus/a.toy", "toy\nextra.bin\n");
    write("bus/extra.bin", "1");
    let path = folder.path().join("a.json");
    let before = LOADER.load(&path).unwrap().fingerprint();
    let names: Vec<&String> = before.parts().keys().filter(|name| name.starts_with("file")).collect();
    assert_eq!(names, ["file a.toy", "file extra.bin", "file paint/wood.bin"]);
    assert_eq!(before.parts()["file a.toy"].split(' ').count(), 2, "each of the two models once");
    let changed = |name: &str, text: &str| {
        let old = fs::read_to_string(folder.path().join(name)).unwrap();
        write(name, text);
        let after = LOADER.load(&path).unwrap().fingerprint();
        write(name, &old);
        let all: BTreeSet<&String> = before.parts().keys().chain(after.parts().keys()).collect();
        let differ = all.into_iter().filter(|name| before.parts().get(*name) != after.parts().get(*name));
        differ.cloned().collect::<Vec<String>>()
    };
    assert_eq!(changed("car/paint/wood.bin", "2"), ["file paint/wood.bin"]);
    assert_eq!(changed("bus/extra.bin", "2"), ["file extra.bin"]);
    assert_eq!(changed("bus/a.toy", "toy\nlit\nextra.bin\n"), ["file a.toy"]);
    // Another order of the models, or another time.
    let other = fs::read_to_string(&path).unwrap();
    let swapped = changed("a.json", &other.replacen("car/a.toy", "bus/a.toy", 1));
    assert_eq!(swapped, ["file a.toy", "models", "objects"]);
    assert!(changed("a.json", &other.replacen("a.toy\"", "a.toy\", \"at\": 0.5", 1)).contains(&"models".to_owned()));
}
