//! Materials of the library: of the catalogue, or by numbers.
//! Those of a file go before those of the catalogue.

use super::{Builder, Part, only_one};
use crate::fault::Fault;
use crate::format::{self, Shock};
use meshfree::material::eos::{Hugoniot, IdealGas, Linear, MieGruneisen};
use meshfree::material::strength::LinearHardening;
use meshfree::material::{Liquid, Material, SoundSpeed, catalogue};

impl<const D: usize> Builder<'_, D> {
    /// The material that a body names, in the file or in the catalogue.
    pub(crate) fn material(&self, name: &str, field: &str) -> Part<Material<f64>> {
        let Some(own) = self.file.material.get(name) else {
            return catalogue::by_name(name).map_err(|unknown| {
                let known: Vec<_> = self.file.material.keys().map(String::as_str).collect();
                let of_file = match known[..] {
                    [] => "the file has none of its own".to_owned(),
                    _ => format!("the file has {}", known.join(", ")),
                };
                Fault::new(field, format!("{unknown}; {of_file}"))
            });
        };
        let field = format!("material.{name}");
        let material = described(own, name, &field)?;
        match material.problems().first() {
            Some(problem) => Err(Fault::of_part(&field, *problem)),
            None => Ok(material),
        }
    }
}

fn described(own: &format::Material, name: &str, field: &str) -> Part<Material<f64>> {
    let given = [
        ("catalogue", own.catalogue.is_some()),
        ("liquid", own.liquid.is_some()),
        ("linear", own.linear.is_some()),
        ("mie_gruneisen", own.mie_gruneisen.is_some()),
        ("ideal_gas", own.ideal_gas.is_some()),
    ];
    only_one(&given, field)?;
    let mut material = if let Some(of) = &own.catalogue {
        let unknown = |unknown| Fault::new(format!("{field}.catalogue"), unknown);
        catalogue::by_name(of).map_err(unknown)?
    } else if let Some(liquid) = &own.liquid {
        let field = format!("{field}.liquid");
        liquid_of(liquid, name, &field)?
    } else if let Some(law) = &own.linear {
        let field = format!("{field}.linear");
        elastic_of(law, name, &field)?
    } else if let Some(law) = &own.mie_gruneisen {
        let form = match law.form {
            Some(Shock::LamCubic) => Hugoniot::LamCubic,
            Some(Shock::Full) | None => Hugoniot::Full,
        };
        let law = MieGruneisen::new(law.density, law.sound_speed, law.slope, law.gruneisen);
        Material::new(name, law.with_form(form))
    } else if let Some(law) = &own.ideal_gas {
        Material::new(name, IdealGas::new(law.gamma, law.density))
    } else {
        return Err(Fault::new(field, "has no law: give it one"));
    };
    if let Some(pressure) = own.pressure_cut_off {
        material = material.with_pressure_cut_off(pressure);
    }
    if let Some(modulus) = own.shear_modulus {
        material = material.with_shear_modulus(modulus);
    }
    if let Some(own) = &own.strength {
        let law = LinearHardening::new(own.yield_stress, own.hardening.unwrap_or(0.0));
        material = material
            .with_yield_stress(own.yield_stress)
            .with_strength(law);
    }
    Ok(material)
}

fn liquid_of(own: &format::LiquidLaw, name: &str, field: &str) -> Part<Material<f64>> {
    let choice = match (own.sound_speed, own.greatest_speed) {
        (None, None) => SoundSpeed::Physical,
        (Some(speed), None) => SoundSpeed::Chosen(speed),
        (None, Some(speed)) => SoundSpeed::artificial(speed),
        (Some(_), Some(_)) => {
            let text = "has `sound_speed` and `greatest_speed` together: give only one of them";
            return Err(Fault::new(field, text));
        }
    };
    let physical = own.physical_sound_speed.unwrap_or(1480.0);
    let liquid = Liquid::new(own.density, physical, own.dynamic_viscosity.unwrap_or(1e-3));
    let liquid = if own.linear { liquid.linear() } else { liquid };
    Ok(liquid.material(name, choice))
}

fn elastic_of(own: &format::Elastic, name: &str, field: &str) -> Part<Material<f64>> {
    match (own.sound_speed, own.youngs_modulus, own.poissons_ratio) {
        (Some(speed), None, None) => Ok(Material::new(name, Linear::new(own.density, speed))),
        (None, Some(youngs), Some(poisson)) => {
            if !(-1.0 < poisson && poisson < 0.5) {
                let text = format!("is {poisson}: it must be above -1 and below 0.5");
                return Err(Fault::new(format!("{field}.poissons_ratio"), text));
            }
            let law = Linear::from_elastic_constants(own.density, youngs, poisson);
            let shear = youngs / (2.0 * (1.0 + poisson));
            Ok(Material::new(name, law).with_shear_modulus(shear))
        }
        _ => {
            let text = "must have either `sound_speed`, or `youngs_modulus` and `poissons_ratio`: give one of them";
            Err(Fault::new(field, text))
        }
    }
}
