//! The networks of real parts that several tests build.

use std::fs;

use glam::DVec3;
use lofting::base::bbox::Box3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::nurbs;
use lofting::network::{Chain, net};
use lofting::surface::blended::coons::{BlendMethod, CoonsSettings, Grid, build};
use lofting::surface::{Reparam, Surface};
use serde_json::Value;

/// Networks and the share of their size by which their own curves miss each other, with a little room.
pub const NETWORKS: [(&str, f64); 6] =
    [("nacelle", 1e-6), ("wing3", 1e-6), ("test_surface4", 1e-6), ("bellyfairing", 1e-6), ("spiralwing", 3e-4), ("fuselage1", 1e-6)];

pub struct Curve {
    pub degree: usize,
    pub knots: Vec<f64>,
    pub poles: Vec<DVec3>,
}

impl Curve {
    pub fn read(value: &Value) -> Self {
        let numbers = |v: &Value| v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect::<Vec<f64>>();
        assert!(value.get("weights").is_none_or(Value::is_null) || numbers(&value["weights"]).iter().all(|w| *w == 1.0));
        Self {
            degree: value["degree"].as_u64().unwrap() as usize,
            knots: numbers(&value["knots"]),
            poles: value["poles"].as_array().unwrap().iter().map(|p| DVec3::from_slice(&numbers(p))).collect(),
        }
    }

    pub fn chain(&self, scale: f64, reversed: bool) -> Chain {
        let (mut poles, mut knots): (Vec<DVec3>, Vec<f64>) = (self.poles.iter().map(|p| *p * scale).collect(), self.knots.clone());
        if reversed {
            poles.reverse();
            knots = self.knots.iter().rev().map(|k| 1.0 - k).collect();
        }
        Chain::of_curve(&nurbs(&poles, &vec![1.0; poles.len()], &knots, self.degree, Origin::NONE).unwrap())
    }
}

pub fn network(name: &str) -> [Vec<Curve>; 2] {
    let text = fs::read_to_string(format!("tests/data/gordon-networks-a/{name}_network.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    ["profiles", "guides"].map(|family| all[family].as_array().unwrap().iter().map(Curve::read).collect())
}

pub fn size(chains: &[Chain]) -> f64 {
    let hull = chains.iter().fold(Box3::EMPTY, |all, chain| all.union(chain.bbox()));
    (hull.max - hull.min).length()
}

pub fn surface(families: [Vec<Chain>; 2], gap: f64) -> (Surface, f64) {
    let size = size(&families.concat());
    let tolerance = Tolerance::new(1e-6 * size, size);
    let near = Tolerance { point: gap * size, ..tolerance };
    let [profiles, guides] = families.map(|family| net::distinct(family, &near));
    let count = profiles.len();
    let chains = [profiles, guides].concat();
    let (flow, nodes) = net::of_net(&chains, count, &near).unwrap();
    let poles = (flow.poles.0.map(|n| nodes[n]), flow.poles.1.map(|n| nodes[n]));
    let settings = CoonsSettings { method: BlendMethod::Gordon, reparam: Reparam::Smooth, origin: Origin::NONE };
    (build(&Grid { chains: &chains, flow: &flow, poles }, &settings, &tolerance).unwrap().0, size)
}

pub fn as_given(name: &str, gap: f64, scale: f64) -> (Surface, f64) {
    surface(network(name).map(|family| family.iter().map(|c| c.chain(scale, false)).collect()), gap)
}
