//! What every page keeps to.

/// The page as a browser would reject it: no number that is none, balanced tags in every plot, nothing fetched.
pub fn assert_sound(page: &str) {
    for svg in page.split("<svg").skip(1).map(|rest| rest.split("</svg>").next().unwrap()) {
        for word in ["NaN", "inf", "null"] {
            assert!(!svg.contains(word), "{word} in <svg{}", &svg[..svg.len().min(400)]);
        }
        for tag in ["<text", "<title"] {
            assert_eq!(svg.matches(tag).count(), svg.matches(&tag.replace('<', "</")).count(), "{tag}");
        }
    }
    for fetched in ["http://", "https://", "src=", "@import", "url("] {
        assert!(!page.contains(fetched), "{fetched} in the page");
    }
    assert!(page.ends_with("</html>\n") || page.ends_with("</html>"));
    assert!(page.len() < 3_000_000, "{} bytes", page.len());
}
