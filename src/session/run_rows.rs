//! The rows of the report: every stage of the model is made, and every mesh.

use super::collect;
use super::run::Run;
use crate::base::bbox::Box3;
use crate::base::tolerance::Tolerance;
use crate::lang::eval::pipeline::Sound;
use crate::lang::values::value::ModuleId;
use crate::model::measure;
use crate::model::topology::Named;

impl Run<'_> {
    /// Rows of the report: all stages are made, and all meshes.
    pub(super) fn collect(&mut self) {
        let main = ModuleId::MAIN;
        let Some(tolerance) = self.cx.tolerance_used() else { return };
        let whole = self.cx.model(main);
        self.take(whole);
        let bounds = match self.cx.sound(main) {
            Ok(sound) => self.geometry(&sound, &tolerance),
            Err(_) => Box3::EMPTY,
        };
        self.report.bounds = collect::corners(bounds);
        if !self.light {
            self.shells(&tolerance);
            self.meshes(&tolerance);
        }
        if let Some(fault) = &self.rows.exceeded {
            self.cx.say(fault);
        }
        self.report.reports = self.cx.reports().iter().map(collect::table).collect();
        self.report.checks = self.cx.checks().iter().map(|check| collect::check(check, &self.cx.program.sources)).collect();
    }

    /// Rows of network and surface model, where something failed of what is sound; gives the box of all, where it is asked for.
    fn geometry(&mut self, sound: &Sound, tolerance: &Tolerance) -> Box3 {
        let Sound { parts, network, model, .. } = sound;
        self.report.network = collect::network_counts(network);
        if self.task.curves {
            self.report.curves = collect::curves(parts, network);
        }
        self.report.modeling = collect::modeling(&self.cx, parts, network, tolerance);
        let (rows, light) = (&mut self.rows, self.light);
        rows.allow_surfaces(model.surfaces.iter().map(|named| &named.surface));
        let mut area = |named: &Named| {
            let what = || format!("the area of `{}`", named.name);
            if light { None } else { rows.part(named.surface.origin(), what, || measure::area(&named.surface)) }
        };
        self.report.surfaces = collect::surfaces(parts, model, &mut area);
        self.flows = collect::flows(&self.cx, parts, model);
        self.report.topology = collect::topology(model, 0);
        if !self.task.full {
            return Box3::EMPTY;
        }
        let mut bounds = network.curves.iter().fold(Box3::EMPTY, |bounds, c| bounds.union(c.curve.bbox()));
        let rows = &mut self.rows;
        let mut own = |named: &Named| {
            let what = || format!("the box of `{}`", named.name);
            rows.part(named.surface.origin(), what, || measure::bounds(std::slice::from_ref(&named.surface)))
        };
        for (row, found) in self.report.surfaces.iter_mut().zip(collect::boxes(parts, model, &mut own)) {
            let found = found.unwrap_or(Box3::EMPTY);
            row.corners = collect::corners(found);
            bounds = row.corners.map_or(bounds, |_| bounds.union(found));
        }
        bounds
    }

    fn meshes(&mut self, tolerance: &Tolerance) {
        for (name, value) in self.cx.mesh_values() {
            let mesh = self.cx.mesh(&value);
            if let Some(mesh) = self.take(mesh) {
                self.report.meshes.push(self.stages.row(&name, &mesh, tolerance, self.task.full));
                self.meshes.push((name.to_string(), mesh));
            }
        }
    }

    fn shells(&mut self, tolerance: &Tolerance) {
        let shells = self.cx.shells(ModuleId::MAIN);
        for shell in self.take(shells).unwrap_or_default() {
            let (cx, full, mut said) = (&mut self.cx, self.task.full, Vec::new());
            self.rows.allow_surfaces(shell.value.surfaces.iter());
            let what = || format!("what the shell `{}` measures", shell.value.name);
            let row = self.rows.part(shell.value.origin, what, || collect::shell(cx, &shell.value, tolerance, full, &mut said));
            if let Some(row) = row.and_then(|row| self.take(row)) {
                said.iter().for_each(|fault| self.cx.say(fault));
                self.report.shells.push(row);
            }
        }
        self.report.topology.shells = self.report.shells.len();
    }
}
