//! A headless Chromium, for tests of what browsers show.
//! Without one such a test says so and passes.

use std::path::Path;

/// What a browser makes of a page with this fragment in its address, after seconds of work at most, and what its console says.
/// `None` without a browser.
pub fn in_a_browser(page: &Path, fragment: &str, seconds: u32) -> Option<(String, String)> {
    let own = format!("meshfree-browser-{}-{fragment}", std::process::id());
    let own = own.replace(|c: char| !c.is_alphanumeric(), "-");
    let profile = std::env::temp_dir().join(own);
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
        .arg(format!("--virtual-time-budget={}", 1000 * seconds))
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}#{fragment}", page.display()))
        .output()
        .ok()?;
    drop(std::fs::remove_dir_all(profile));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Some((text(&done.stdout), text(&done.stderr)))
}
