//! What a run leaves behind, taken out of its evaluated script.

use std::sync::Arc;

use super::curve::Curve;
use super::names::Names;
use super::surface::Surface;
use crate::base::fault::Say;
use crate::base::tolerance::Tolerance;
use crate::lang::eval::context::Cx;
use crate::lang::eval::scene::Scene;
use crate::lang::values::units::LengthUnit;
use crate::lang::values::value::{ModuleId, ShellValue};

/// The geometry of a script as far as it is sound.
pub struct Loaded {
    pub scene: Scene,
    pub tolerance: Tolerance,
    pub unit: LengthUnit,
    pub names: Names,
    pub curves: Vec<Curve>,
    pub surfaces: Vec<Surface>,
    pub shells: Vec<Arc<ShellValue>>,
}

impl Loaded {
    /// That of the main script; `None` where it could not be read.
    pub fn of(cx: &mut Cx) -> Option<Self> {
        let main = ModuleId::MAIN;
        let tolerance = cx.tolerance_used()?;
        let sound = cx.sound(main).ok()?;
        let declared = if sound.stands { cx.shells(main).unwrap_or_default() } else { Vec::new() };
        let shells: Vec<Arc<ShellValue>> = declared.into_iter().map(|shell| shell.value).collect();
        let scene = Scene { model: sound.model, network: sound.network };
        let scene = match scene.clone().with(cx, shells.iter().flat_map(|shell| &shell.surfaces)) {
            Ok(scene) => scene,
            Err(_) => scene,
        };
        let mut names = Names::default();
        for named in &scene.model.surfaces {
            names.add(named.surface.origin(), &named.name);
            named.surface.chains().iter().for_each(|chain| names.add(chain.origin(), &cx.name(chain.origin())));
        }
        let curves = sound.parts.curves.iter().chain(&sound.parts.modeling);
        let curves: Vec<Curve> = curves.map(|curve| Curve::of_chain(&curve.value, &curve.name)).collect();
        let surfaces: Vec<Surface> = sound.parts.surfaces.iter().map(|s| Surface::of_surface(&s.value, &s.name)).collect();
        curves.iter().for_each(|curve| names.add(curve.origin(), curve.name()));
        surfaces.iter().for_each(|surface| names.add(surface.surface.origin(), surface.name()));
        Some(Self { scene, tolerance, unit: cx.unit(), names, curves, surfaces, shells })
    }
}
