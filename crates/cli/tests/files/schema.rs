//! The schema lists every key of the format, with what it is.
//! Keys are read from the text of the format, not from its types.

use meshfree_cli::command::schema;
use serde_json::Value;
use std::collections::BTreeMap;

/// Keys of all objects of a schema, with their descriptions.
fn keys(value: &Value, found: &mut BTreeMap<String, bool>) {
    match value {
        Value::Object(own) => {
            if let Some(Value::Object(properties)) = own.get("properties") {
                for (key, property) in properties {
                    let is_told = property.get("description").is_some();
                    *found.entry(key.clone()).or_insert(true) &= is_told;
                }
            }
            own.values().for_each(|value| keys(value, found));
        }
        Value::Array(own) => own.iter().for_each(|value| keys(value, found)),
        _ => {}
    }
}

#[test]
fn the_schema_lists_every_key() {
    let schema: Value = serde_json::from_str(&schema()).expect("JSON");
    let mut found = BTreeMap::new();
    keys(&schema, &mut found);
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/format");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("the format").flatten() {
        let text = std::fs::read_to_string(entry.path()).expect("a text");
        let fields = text.lines().filter_map(|line| {
            let line = line.trim().strip_prefix("pub ")?;
            let (name, _) = line.split_once(": ")?;
            (!name.contains(' ')).then_some(name)
        });
        for name in fields {
            assert!(found.contains_key(name), "`{name}` is not in the schema");
            count += 1;
        }
    }
    assert!(count > 80, "{count} keys");
    for required in [
        "weakly_compressible",
        "cuboid",
        "mesh",
        "displacement",
        "outside_box",
    ] {
        assert!(
            found.contains_key(required),
            "`{required}` is not in the schema"
        );
    }
    // A key that is not in the format is no key of the schema either.
    assert!(!found.contains_key("folders"));
}
