//! What must always hold of a network.

use super::graph::{LinkId, NetCurve, Network};

impl Network {
    /// What must always hold; the sentence says what is broken.
    pub fn check(&self) -> Result<(), String> {
        for (k, net) in self.curves.iter().enumerate() {
            self.check_curve(k, net)?;
        }
        if let Some(k) = self.links.iter().position(|link| link.nodes.0.index().max(link.nodes.1.index()) >= self.nodes.len()) {
            return Err(format!("link {k} ends in a node that does not exist"));
        }
        if let Some(k) = self.link_ends().iter().position(Vec::is_empty) {
            return Err(format!("node {k} has no link"));
        }
        for (k, link) in self.links.iter().enumerate() {
            let owner = &self.curves[link.curve.index()];
            if !owner.links.contains(&(LinkId::at(k), false)) {
                return Err(format!("link {k} is not run over by its owner `{}`", owner.name));
            }
            if link.s.0 >= link.s.1 {
                return Err(format!("link {k} runs backwards along its owner"));
            }
        }
        Ok(())
    }

    fn check_curve(&self, k: usize, net: &NetCurve) -> Result<(), String> {
        let name = &net.name;
        if net.links.is_empty() {
            return Err(format!("curve `{name}` runs over no link"));
        }
        if net.nodes.len() != net.links.len() + 1 || net.stations.len() != net.nodes.len() {
            return Err(format!(
                "curve `{name}` has {} links, {} nodes and {} stations",
                net.links.len(),
                net.nodes.len(),
                net.stations.len()
            ));
        }
        if !net.stations.windows(2).all(|w| w[0] < w[1]) {
            return Err(format!("the stations of `{name}` do not ascend"));
        }
        let (length, last) = (net.curve.length(), net.stations[net.stations.len() - 1]);
        let ring = net.nodes.first() == net.nodes.last() && last == net.stations[0] + length;
        if !ring && (net.stations[0], last) != (0.0, length) {
            return Err(format!("`{name}` does not run from its start to its end"));
        }
        for (i, &(link, against)) in net.links.iter().enumerate() {
            let link = &self.links[link.index()];
            let ends = if against { (link.nodes.1, link.nodes.0) } else { link.nodes };
            if ends != (net.nodes[i], net.nodes[i + 1]) {
                return Err(format!("link {i} of `{name}` does not join its neighbours"));
            }
            let owner = link.curve.index();
            if owner != k && (self.curves[owner].name > *name) {
                return Err(format!("a shared link of `{name}` belongs to `{}`, which comes later by name", self.curves[owner].name));
            }
        }
        Ok(())
    }
}
