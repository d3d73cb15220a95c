//! Gases in two dimensions: Noh's implosion and Sedov's blast.
//! Others lose energy or heat the middle.

use super::harness::Row;
use super::imploding_gas::{BARE, CONDUCTING, FORMS, closed, implosion, sedov};
use meshfree::scheme::EnergyForm;

#[test]
fn noh_implodes_to_a_plateau_in_a_plane() {
    let case = "Noh's implosion 2D, 50 a radius";
    let runs = FORMS.map(|form| implosion::<2>(CONDUCTING, form, 50));
    let bare = implosion::<2>(BARE, EnergyForm::Compatible, 50);
    Row {
        case,
        criterion: "error of the mean of the plateau; control: no viscosity, fixed h",
        value: runs[0].plateau,
        control: bare.plateau,
    }
    .at_most(0.15);
    closed(case, runs.map(|run| run.energy));
}

#[test]
fn a_point_blast_runs_as_sedov_says() {
    sedov::<2>("Sedov's blast 2D, 50 a metre", 50, 4.0);
}
