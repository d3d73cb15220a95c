//! Arrays that a driver binds in parts: texts of kernels that read and write them through functions.
//! Which array has how many parts is known when memory is bound; a text without parts is left as it is.

use crate::kernel::Array;

/// Arrays that any kernel has at most.
pub const MOST_ARRAYS: u32 = 9;

/// The names under which the parts of an array are bound.
pub fn names(name: &str, parts: u64) -> Vec<String> {
    match parts {
        0 | 1 => vec![name.into()],
        _ => (0..parts).map(|k| format!("{name}_{k}")).collect(),
    }
}

/// Functions that read and write an element of an array of parts, in WGSL: each part has `length` elements of a type.
pub fn functions(array: &Array, of: &str, (parts, length): (u64, u64)) -> String {
    let name = array.name;
    let part = |k: u64| format!("{name}_{k}[i - {}u]", k * length);
    let each = |act: &dyn Fn(String) -> String| -> String {
        let ends = (0..parts - 1).map(|k| {
            let end = (k + 1) * length;
            format!("if (i < {end}u) {{ {} }}\n", act(part(k)))
        });
        ends.chain([act(part(parts - 1))]).collect()
    };
    let reads = each(&|from| format!("return {from};"));
    let mut all = format!("fn {name}_at(i: u32) -> {of} {{\n{reads}\n}}\n");
    if array.writable {
        let writes = each(&|to| format!("{to} = own; return;"));
        all += &format!("fn {name}_put(i: u32, own: {of}) {{\n{writes}\n}}\n");
    }
    all
}

/// A body that reads and writes an array through these functions.
pub fn through_functions(body: &str, name: &str) -> String {
    let (mut all, mut rest) = (String::new(), body);
    let head = format!("{name}[");
    while let Some(at) = rest.find(&head) {
        let (before, own) = rest.split_at(at);
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        let (inside, behind) = enclosed(&own[head.len()..]);
        all += before;
        if before.ends_with(is_name) {
            // The end of a longer name.
            all += &head;
            rest = &own[head.len()..];
            continue;
        }
        let index = through_functions(inside, name);
        let written = behind.strip_prefix(" = ");
        if let Some((value, behind)) = written.and_then(|own| own.split_once(';')) {
            let value = through_functions(value, name);
            all += &format!("{name}_put({index}, {value});");
            rest = behind;
        } else {
            all += &format!("{name}_at({index})");
            rest = behind;
        }
    }
    all + rest
}

/// What stands before the bracket that closes an open one, and what stands behind it.
fn enclosed(text: &str) -> (&str, &str) {
    let mut open = 1;
    for (at, c) in text.char_indices() {
        match c {
            '[' => open += 1,
            ']' => open -= 1,
            _ => {}
        }
        if open == 0 {
            return (&text[..at], &text[at + 1..]);
        }
    }
    (text, "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_read_and_written_by_functions() {
        let body = "x = keys[list[keys[i] + 1u]] == 2u;\nkeys[2u * i] = keys[i] + my_keys[i];\n";
        let own = "x = keys_at(list[keys_at(i) + 1u]) == 2u;\nkeys_put(2u * i, keys_at(i) + my_keys[i]);\n";
        assert_eq!(through_functions(body, "keys"), own);
        let own = "x = keys[list_at(keys[i] + 1u)] == 2u;\nkeys[2u * i] = keys[i] + my_keys[i];\n";
        assert_eq!(through_functions(body, "list"), own);
    }

    #[test]
    fn a_part_follows_another() {
        let all = functions(&Array::indices("keys").written(), "u32", (3, 64));
        assert!(
            all.contains("if (i < 64u) { return keys_0[i - 0u]; }"),
            "{all}"
        );
        assert!(all.contains("keys_2[i - 128u] = own;"), "{all}");
        assert_eq!(names("keys", 1), ["keys"]);
        assert_eq!(names("keys", 2), ["keys_0", "keys_1"]);
    }
}
