//! Curves in one network.

use std::sync::Arc;

use super::curve::Curve;
use super::error::{Error, row};
use super::names::{Names, Speaker};
use crate::base::fault::{Fault, ValueFault};
use crate::base::job::Job;
use crate::base::limits::{STAGE_WORK, WORK_OF_A_CURVE};
use crate::base::tolerance::Tolerance;
use crate::base::work::{Budget, Exceeded};
use crate::network;
use crate::session::network_inputs::inputs;
use crate::session::report::DiagnosticRow;
use crate::surface;

/// Nodes and links of curves that meet: crossings, touches and shared runs are found, within a [`Tolerance`].
///
/// ```
/// use lofting::{Curve, Network, Tolerance};
///
/// let along = Curve::line((-1.0, 0.0, 0.0), (1.0, 0.0, 0.0))?.named("along");
/// let across = Curve::line((0.0, -1.0, 0.0), (0.0, 1.0, 0.0))?.named("across");
/// let network = Network::of([&along, &across], &Tolerance::new(1e-6, 3.0))?;
/// assert_eq!((network.nodes().len(), network.links().len()), (5, 4));
/// # Ok::<(), lofting::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Network {
    pub(super) network: Arc<network::Network>,
    notes: Vec<DiagnosticRow>,
}

impl Network {
    /// The network of curves.
    pub fn of<'a>(curves: impl IntoIterator<Item = &'a Curve>, tolerance: &Tolerance) -> Result<Self, Error> {
        let curves: Vec<Curve> = curves.into_iter().cloned().collect();
        let mut names = Names::default();
        curves.iter().for_each(|curve| names.add(curve.origin(), curve.name()));
        Self::under(&curves, &[], &Speaker { names: &names, unit: None, tolerance: Some(*tolerance) }, tolerance)
    }

    /// The network of curves and of those that surfaces stand on.
    pub(super) fn under(curves: &[Curve], surfaces: &[surface::Surface], say: &Speaker, tolerance: &Tolerance) -> Result<Self, Error> {
        let names: Vec<String> = curves.iter().enumerate().map(|(k, curve)| name_of(curve, k)).collect();
        let named: Vec<_> = names.iter().map(String::as_str).zip(curves.iter().map(|curve| &curve.chain)).collect();
        let inputs = inputs(&named, Vec::new(), &surfaces.iter().collect::<Vec<_>>(), &|origin| say.names.of(origin), tolerance);
        let work = STAGE_WORK.saturating_add(WORK_OF_A_CURVE.saturating_mul(inputs.len() as u64));
        let mut said: Vec<Fault> = Vec::new();
        let build = || network::Network::build(inputs, &[], tolerance, &Job::new(), &mut said);
        let too_much = |Exceeded| Err(ValueFault::StageWork { what: "the network" }.into());
        let network = Budget::new(work).within(build).unwrap_or_else(too_much).map_err(|fault| Error::of_fault(&fault, say))?;
        Ok(Self { network: Arc::new(network), notes: said.iter().map(|fault| row(fault, say)).collect() })
    }

    pub(super) fn of_script(network: &Arc<network::Network>) -> Self {
        Self { network: network.clone(), notes: Vec::new() }
    }

    /// Places of the nodes, numbered by place and name, whatever the order in which curves are given.
    pub fn nodes(&self) -> Vec<[f64; 3]> {
        self.network.nodes.iter().map(|node| node.point.to_array()).collect()
    }

    /// The links as numbers of their first and last node; of a closed curve that nothing meets both are one.
    pub fn links(&self) -> Vec<[usize; 2]> {
        self.network.links.iter().map(|link| [link.nodes.0.index(), link.nodes.1.index()]).collect()
    }

    /// The run of a curve that a link is; `None` for a number that no link has.
    pub fn link(&self, number: usize) -> Option<Curve> {
        let link = (number < self.network.links.len()).then(|| network::LinkId::at(number))?;
        Some(Curve::of_chain(&self.network.link_chain(link), &format!("link_{}", number + 1)))
    }

    /// The curves by name, each with the numbers of the links that it runs over.
    pub fn curves(&self) -> Vec<(String, Vec<usize>)> {
        let row = |curve: &network::graph::NetCurve| (curve.name.clone(), curve.links.iter().map(|link| link.0.index()).collect());
        self.network.curves.iter().map(row).collect()
    }

    /// Warnings and notes of its making: ends that nearly meet, curves that run along each other. Those of a script stand with the model.
    pub fn diagnostics(&self) -> &[DiagnosticRow] {
        &self.notes
    }
}

/// A name for each curve, by its place where it has none.
fn name_of(curve: &Curve, place: usize) -> String {
    if curve.name().is_empty() { format!("curve_{}", place + 1) } else { curve.name().to_owned() }
}
