//! Browser: what a headless Chromium makes of the page of costs.
//! Without one the test says so and passes.

use std::fs;
use std::path::Path;

/// What a browser makes of the page of costs at an address, and what its console says. `None` without a browser.
fn in_a_browser(page: &Path, fragment: &str) -> Option<(String, String)> {
    let profile = std::env::temp_dir().join(format!("meshfree-browser-{}", std::process::id()));
    let done = std::process::Command::new("chromium")
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
        ])
        .args([
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
        ])
        .args(["--enable-logging=stderr", "--v=0", "--dump-dom"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}#{fragment}", page.display()))
        .output()
        .ok()?;
    drop(fs::remove_dir_all(profile));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Some((text(&done.stdout), text(&done.stderr)))
}

/// Points that are drawn and runs that are listed.
fn drawn(dom: &str) -> [usize; 2] {
    ["data-points=\"", "data-rows=\""].map(|name| {
        let rest = dom.split_once(name).map_or("", |(_, rest)| rest);
        rest.split('"')
            .next()
            .and_then(|n| n.parse().ok())
            .unwrap_or(0)
    })
}

#[test]
fn the_page_of_costs_draws_and_filters_in_a_browser() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/accuracy.html");
    let Some((dom, console)) = in_a_browser(&page, "") else {
        println!("skipped: there is no chromium");
        return;
    };
    let [points, rows] = drawn(&dom);
    assert!(
        points > 20 && rows >= points,
        "{points} points of {rows} rows"
    );
    // The script in the page has the text of a mark, too.
    let marks = dom.matches("data-row=\"").count() - dom.matches("data-row=\"${").count();
    assert!((points..=rows).contains(&marks), "{marks} marks");
    let (less, also) =
        in_a_browser(&page, "filter=default&x=pairs&most=0.05").expect("it was there");
    let [fewer, listed] = drawn(&less);
    assert!(
        fewer > 0 && fewer < points && listed < rows,
        "{fewer} of {points}"
    );
    // The cheapest run of these is told, with the command that repeats it.
    let told = less.split_once("id=\"point\"").map_or("", |(_, rest)| rest);
    let told = told.split("</p>").next().unwrap_or_default();
    assert!(
        told.contains("--spacing ") && told.contains("default"),
        "{told}"
    );
    for said in [console, also] {
        assert!(!said.contains("CONSOLE"), "{said}");
    }
    assert!(!dom.contains("data-error") && !less.contains("data-error"));
}
