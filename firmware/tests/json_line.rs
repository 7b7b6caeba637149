//! Lines that an image prints for the host.

use driveline_firmware::board::json_line::Line;

#[test]
fn a_line_is_one_json_object() {
    let mut line = Line::new().text("name", "tick").number("zero", 0).number("most", u32::MAX).hex("hash", 0x1f);
    let expected = b"{\"name\":\"tick\",\"zero\":0,\"most\":4294967295,\"hash\":\"000000000000001f\"}\n";
    assert_eq!(line.finish(), expected);
}
