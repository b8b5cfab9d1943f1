//! The network of a session as tables.

use glam::DVec3;

use super::{Answer, Notebook, Part};
use crate::base::tolerance::Tolerance;
use crate::lang::eval::context::Cx;
use crate::lang::eval::pipeline::Parts;
use crate::lang::values::value::{ModuleId, Value};
use crate::network::{LinkId, Network};
use crate::session::collect;
use crate::session::live::Depth;
use crate::session::report::{Cell, Column, Table};

fn column(name: &str, unit: Option<&str>) -> Column {
    Column { name: name.to_owned(), unit: unit.map(str::to_owned) }
}

fn text(text: impl Into<String>) -> Cell {
    Cell::Text(text.into())
}

/// A place as far as the tolerance resolves it.
fn place(p: DVec3, tolerance: &Tolerance) -> Cell {
    Cell::List(tolerance.rounded(p).to_array().map(Cell::Number).to_vec())
}

/// For each node the curves that run through it, by name.
fn meeting(network: &Network) -> Vec<Vec<&str>> {
    let mut names: Vec<Vec<&str>> = vec![Vec::new(); network.nodes.len()];
    for curve in &network.curves {
        for node in &curve.nodes {
            let of = &mut names[node.index()];
            if of.last() != Some(&curve.name.as_str()) {
                of.push(&curve.name);
            }
        }
    }
    names
}

fn curves(parts: &Parts, network: &Network, unit: &str) -> Table {
    let row = |c: &crate::network::graph::NetCurve| {
        let links: Vec<String> = c.links.iter().map(|(l, _)| (l.0 + 1).to_string()).collect();
        vec![text(&c.name), text(c.curve.kind().name()), Cell::Number(c.curve.length()), text(links.join(" "))]
    };
    let title = format!("{} curves, {} links, {} nodes", network.curves.len(), network.links.len(), network.nodes.len());
    let columns = vec![column("curve", None), column("kind", None), column("length", Some(unit)), column("links", None)];
    Table { title, columns, rows: collect::curves_in_order(parts, network).into_iter().map(|k| row(&network.curves[k])).collect() }
}

fn nodes(network: &Network, unit: &str, tolerance: &Tolerance) -> Table {
    let (names, ends) = (meeting(network), network.link_ends());
    let row = |(n, node): (usize, &crate::network::graph::Node)| {
        vec![Cell::Number((n + 1) as f64), place(node.point, tolerance), Cell::Number(ends[n].len() as f64), text(names[n].join(", "))]
    };
    let columns = vec![column("node", None), column("at", Some(unit)), column("links", None), column("of", None)];
    Table { title: String::new(), columns, rows: network.nodes.iter().enumerate().map(row).collect() }
}

fn links(network: &Network, of: &[(LinkId, bool)], unit: &str, tolerance: &Tolerance) -> Table {
    let row = |(id, against): &(LinkId, bool)| {
        let link = &network.links[id.index()];
        let (a, b) = if *against { (link.nodes.1, link.nodes.0) } else { link.nodes };
        vec![
            Cell::Number(f64::from(id.0 + 1)),
            text(&network.curves[link.curve.index()].name),
            Cell::Number(link.s.1 - link.s.0),
            Cell::Number(f64::from(a.0 + 1)),
            place(network.nodes[a.index()].point, tolerance),
            Cell::Number(f64::from(b.0 + 1)),
            place(network.nodes[b.index()].point, tolerance),
        ]
    };
    let columns = vec![
        column("link", None),
        column("of", None),
        column("length", Some(unit)),
        column("from", None),
        column("at", Some(unit)),
        column("to", None),
        column("at", Some(unit)),
    ];
    Table { title: String::new(), columns, rows: of.iter().map(row).collect() }
}

/// What stands before a remark behind a title.
fn title_before(title: &str) -> String {
    if title.is_empty() { String::new() } else { format!("{title}, ") }
}

impl Notebook {
    pub(super) fn network(&mut self, _: &str) -> Answer {
        self.tabled(&mut |cx, network| {
            let parts = cx.sound(ModuleId::MAIN).map(|sound| sound.parts).unwrap_or_default();
            Ok(curves(&parts, network, cx.unit().name))
        })
    }

    pub(super) fn nodes(&mut self, _: &str) -> Answer {
        self.tabled(&mut |cx, network| {
            let tolerance = cx.tolerance_used().ok_or("the model has no tolerance yet")?;
            Ok(nodes(network, cx.unit().name, &tolerance))
        })
    }

    pub(super) fn links(&mut self, name: &str) -> Answer {
        self.tabled(&mut |cx, network| {
            let Some(Value::Curve(chain)) = cx.value_of(name) else { return Err(format!("`{name}` is not a curve of this model")) };
            let tolerance = cx.tolerance_used().ok_or("the model has no tolerance yet")?;
            match network.links_of(&chain, &tolerance) {
                Some(found) => Ok(links(network, &found, cx.unit().name, &tolerance)),
                None => Err(format!("`{name}` is not in the network")),
            }
        })
    }

    fn tabled(&mut self, make: &mut (dyn FnMut(&mut Cx<'_>, &Network) -> Result<Table, String> + Send)) -> Answer {
        let mut made = Err("there is no network yet".to_owned());
        let state = self.now.state.clone();
        let result = self.run(&state, Depth::Values, &mut |cx| {
            let whole = cx.network(ModuleId::MAIN).is_ok();
            if let Ok(sound) = cx.sound(ModuleId::MAIN) {
                made = make(cx, &sound.network);
                if let (false, Ok(table)) = (whole, &mut made) {
                    table.title = format!("{}{}", title_before(&table.title), "without what could not be made");
                }
            }
        });
        match (result, made) {
            (Err(answer), _) => answer,
            (Ok(_), Ok(table)) => Answer { parts: vec![Part::Table(table)], ..Answer::default() },
            (Ok(_), Err(words)) => Answer::failure(words),
        }
    }
}
