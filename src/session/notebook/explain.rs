//! How a name of the model came about: its statement, what it stands on, how it was ordered, counted and meshed.

use super::{Answer, Notebook, Part};
use crate::lang::eval::context::{Cx, Sound};
use crate::lang::values::value::{ModuleId, Value};
use crate::network::Network;
use crate::session::live::Depth;

impl Notebook {
    /// Tells all that is known of a name, or of an expression such as `south & ring`.
    pub fn explain(&mut self, what: &str) -> Answer {
        let Some(symbol) = self.now.symbols.iter().find(|s| s.name.as_deref() == Some(what)).cloned() else {
            let mut answer = self.explain_expression(what);
            let family = what.split_once('[').map(|(base, _)| base.trim());
            if !answer.failed && self.now.symbols.iter().any(|s| s.name.is_some() && s.name.as_deref() == family) {
                answer.parts.extend(self.why(what).parts);
            }
            return answer;
        };
        let text = self.now.state.text.get(symbol.span.start as usize..symbol.span.end as usize).unwrap_or("").to_owned();
        let line = 1 + self.now.state.text[..symbol.span.start as usize].matches('\n').count();
        let mut details: Vec<String> = Vec::new();
        let state = self.now.state.clone();
        let result = self.run(&state, Depth::Report, &mut |cx| {
            details.extend(cx.describe_name(what));
            if let Some(value) = cx.value_of(what) {
                about(cx, &value, &mut details);
            }
        });
        let outcome = match result {
            Ok(outcome) => outcome,
            Err(answer) => return answer,
        };
        let mut answer = Answer::text(format!("{}:{line}", self.live.name()));
        answer.parts.extend(symbol.doc.clone().map(Part::Text));
        answer.say(text);
        details.into_iter().for_each(|line| answer.say(line));
        // What was found on the way speaks of surfaces and meshes by name.
        let names = [format!("surface {what}"), format!("mesh {what}")];
        let speaks = |note: &&String| names.iter().any(|n| note.strip_prefix(n.as_str()).is_some_and(|rest| rest.starts_with([':', '['])));
        let speaks = |note: &&String| speaks(note) || of_mesh(note, what);
        outcome.notes.iter().filter(speaks).for_each(|note| answer.say(note.clone()));
        let why = self.why(what);
        answer.parts.extend(why.parts);
        answer.failed = symbol.condition != crate::lang::run::symbols::Condition::Sound;
        if answer.failed {
            answer.parts.push(Part::Said(outcome.drawn(self.color, false)));
        }
        answer
    }

    fn explain_expression(&mut self, what: &str) -> Answer {
        let mut answer = self.ask(what);
        if answer.failed {
            return answer;
        }
        let state = self.with_answer(what);
        let mut details: Vec<String> = Vec::new();
        let result = self.run(&state, Depth::Values, &mut |cx| {
            if let Some(value) = cx.value_of(super::ANSWER) {
                about(cx, &value, &mut details);
            }
        });
        if let Err(answer) = result {
            return answer;
        }
        details.into_iter().for_each(|line| answer.say(line));
        answer
    }
}

/// Whether a note on a mesh speaks of a face or of an edge of what has this name: "mesh m: strip of south, north: …".
fn of_mesh(note: &str, what: &str) -> bool {
    let Some((_, said)) = note.strip_prefix("mesh ").and_then(|rest| rest.split_once(": ")) else { return false };
    let named = |words: &str| words.split_once(": ").is_some_and(|(names, _)| names.split(", ").any(|name| name == what));
    match said.strip_prefix("strip of ") {
        Some(strip) => named(strip),
        None => said.strip_prefix("face ").and_then(|rest| rest.split_once(" of ")).is_some_and(|(_, rest)| named(rest)),
    }
}

/// What the network knows of a value.
fn about(cx: &mut Cx<'_>, value: &Value, out: &mut Vec<String>) {
    if let Some(part) = value.part() {
        return out.extend(part.summary(cx.unit().name));
    }
    let Ok(Sound { network, .. }) = cx.sound(ModuleId::MAIN) else { return };
    let Some(tolerance) = cx.tolerance_used() else { return };
    match value {
        Value::Curve(chain) => {
            for (id, against) in network.links_of(chain, &tolerance).unwrap_or_default() {
                let link = &network.links[id.index()];
                let (a, b) = if against { (link.nodes.1, link.nodes.0) } else { link.nodes };
                let place = |n: crate::network::NodeId| cx.show(&Value::Node(network.nodes[n.index()].point));
                let length = cx.measured(link.s.1 - link.s.0, crate::lang::values::value::Dim::LENGTH);
                let owner = &network.curves[link.curve.index()].name;
                let (from, to) = (place(a), place(b));
                out.push(format!("  link {} of {owner}, {length}: node {} {from} to node {} {to}", id.0 + 1, a.0 + 1, b.0 + 1));
            }
        }
        Value::Node(p) => out.extend(network.node_at(*p, &tolerance).map(|n| node(cx, &network, n.index()))),
        Value::Vector(p, dim) if !dim.is_none() => out.extend(network.node_at(*p, &tolerance).map(|n| node(cx, &network, n.index()))),
        _ => {}
    }
}

/// "node 5 at (4m, 0m, 0m): where front, rafter meet".
fn node(cx: &Cx<'_>, network: &Network, n: usize) -> String {
    let names: Vec<&str> =
        network.curves.iter().filter(|c| c.nodes.iter().any(|other| other.index() == n)).map(|c| c.name.as_str()).collect();
    let place = cx.show(&Value::Node(network.nodes[n].point));
    let what = if names.len() == 1 { "a node of" } else { "where these meet:" };
    format!("  node {} at {place}, {what} {}", n + 1, names.join(", "))
}
