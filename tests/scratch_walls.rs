#[path = "liquids/across_boundaries.rs"]
mod across_boundaries;
#[path = "liquids/drum.rs"]
mod drum;
