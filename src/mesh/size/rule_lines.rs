//! The lines that rules on curves and edges apply to: their segments and links, and how a written count is shared out to these.

use crate::mesh::border::counts::share;
use crate::mesh::border::layout::Layout;
use crate::mesh::request::input::Input;
use crate::model::Course;
use crate::model::segments::SegmentUse;
use crate::network::Chain;

/// A line that a rule applies to, as it is in the mesh.
pub(super) struct RuleLine {
    /// Its segments along it.
    pub uses: Vec<SegmentUse>,
    /// Its links with their segments; what is no run of links is one.
    pub links: Vec<LinkRange>,
    /// Arc length, model units.
    pub length: f64,
}

/// One link of a chain with its segments.
pub(super) struct LinkRange {
    /// Arc length, model units.
    length: f64,
    /// Places of its segments among those of the line.
    uses: std::ops::Range<usize>,
}

impl RuleLine {
    /// The line of a chain.
    pub(super) fn of_chain(input: &Input, layout: &Layout, chain: &Chain) -> Self {
        let (uses, links) = segments_of(input, layout, chain);
        Self { uses, links, length: chain.length() }
    }

    /// A count shared out to links by length, then to the segments of each link; lengths that differ by no more than `near` are alike.
    ///
    /// Fails with the number of segments where the count is less.
    pub(super) fn count_shares(&self, count: u32, near: f64) -> Result<Vec<u32>, u32> {
        let least: Vec<u32> = self.links.iter().map(|l| (l.uses.len() as u32).max(1)).collect();
        let weights: Vec<f64> = self.links.iter().map(|l| l.length).collect();
        let by_link = share(count, &weights, near, &least).ok_or(least.iter().sum::<u32>())?;
        let mut shares = Vec::new();
        for (n, link) in by_link.iter().zip(&self.links) {
            let lengths: Vec<f64> = self.uses[link.uses.clone()].iter().map(|u| u.s.1 - u.s.0).collect();
            // A link of which only a part is meshed gives that part its share.
            let covered: f64 = lengths.iter().sum::<f64>() / link.length;
            let own = ((f64::from(*n) * (covered + near / link.length) + 0.5).floor() as u32).max(lengths.len() as u32);
            shares.extend(share(own, &lengths, near, &vec![1; lengths.len()]).unwrap_or_default());
        }
        Ok(shares)
    }
}

/// The borders that an edge is in the mesh, each segment once.
pub(super) fn lines_of_edge(layout: &Layout, courses: &[Course]) -> Vec<RuleLine> {
    let mut known: Vec<usize> = Vec::new();
    let mut lines = Vec::new();
    for course in courses {
        let mut uses = layout.along_course(course);
        uses.retain(|u| !known.contains(&u.segment));
        known.extend(uses.iter().map(|u| u.segment));
        let length: f64 = course.iter().map(|part| part.s.1 - part.s.0).sum();
        if !uses.is_empty() {
            let links = vec![LinkRange { length, uses: 0..uses.len() }];
            lines.push(RuleLine { uses, links, length });
        }
    }
    lines
}

/// Segments of a chain and of its links, which hold all of them.
fn segments_of(input: &Input, layout: &Layout, chain: &Chain) -> (Vec<SegmentUse>, Vec<LinkRange>) {
    let uses = layout.along(input, chain);
    let Some(links) = links_of(input, chain) else {
        let all = 0..uses.len();
        return (uses, vec![LinkRange { length: chain.length(), uses: all }]);
    };
    let (mut ranges, mut start, mut from) = (Vec::new(), 0.0, 0);
    for (n, s) in links.iter().enumerate() {
        let end = if n + 1 == links.len() { f64::INFINITY } else { start + (s.1 - s.0) };
        let to = from + uses[from..].iter().take_while(|u| 0.5 * (u.s.0 + u.s.1) < end).count();
        ranges.push(LinkRange { length: s.1 - s.0, uses: from..to });
        (start, from) = (end, to);
    }
    (uses, ranges)
}

/// Arc lengths of the links of a chain on their curves.
pub fn links_of(input: &Input, chain: &Chain) -> Option<Vec<(f64, f64)>> {
    let links = input.network.links_of(chain, input.tolerance)?;
    Some(links.into_iter().map(|(link, _)| input.network.links[link.index()].s).collect())
}
