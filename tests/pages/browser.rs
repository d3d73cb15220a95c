//! Browser: what a headless Chromium makes of the page of costs.
//! Without one the test says so and passes.

use crate::headless::in_a_browser;
use std::path::Path;

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
    let Some((dom, console)) = in_a_browser(&page, "", 10) else {
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
        in_a_browser(&page, "filter=default&x=pairs&most=0.05", 10).expect("it was there");
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
