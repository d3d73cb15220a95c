//! What a picture shows, pixel by pixel, and what it refuses.
//! Small pictures, so that each expected pixel can be counted by hand.

use super::*;

const RED: Color = Color(200, 0, 0);
const BLUE: Color = Color(0, 0, 200);
