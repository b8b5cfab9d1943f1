//! Fewer irregular nodes in plane nets: cavities about them are filled anew, with patterns that have fewer.

use glam::DVec2;

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::work;
use crate::mesh::chart::parametric_surface::{SizeField, Spot};
use crate::mesh::quad::cavity::{Cavity, Content, EditableNet, Rim};
use crate::mesh::quad::net::Net;
use crate::mesh::quad::pattern::{Pattern, irregular, pattern};
use crate::mesh::quad::plane::least_sine;
use crate::mesh::quad::settings::REGULAR;

/// What a net is on.
pub(super) struct RegularInput<'a> {
    /// The plane.
    pub plane: Spot,
    pub field: &'a dyn SizeField,
    /// Length up to which sides are allowed anywhere, model units.
    pub always: f64,
    /// Whether lines run through it.
    pub has_lines: bool,
}

/// Fills cavities anew until no irregular node goes; whether any went.
pub(super) fn regularize(net: &mut Net, input: &RegularInput, job: &Job) -> Result<bool> {
    let mut regular = Regular { of: EditableNet::new(net), input, cavity: Cavity::default() };
    let mut any = false;
    for most in REGULAR.max_faces {
        for _ in 0..REGULAR.max_rounds {
            let mut gained = false;
            for node in regular.of.net.fixed..regular.of.net.p.len() as u32 {
                if regular.of.is_irregular(node) {
                    job.go_on()?;
                    gained |= regular.fill_about(node, most);
                }
            }
            any |= gained;
            if !gained {
                break;
            }
        }
    }
    if any {
        regular.of.compact();
    }
    Ok(any)
}

struct Regular<'a> {
    of: EditableNet<'a>,
    input: &'a RegularInput<'a>,
    cavity: Cavity,
}

impl Regular<'_> {
    /// Fills a cavity about a node with a pattern of fewer irregular nodes; whether there is one.
    fn fill_about(&mut self, node: u32, most: usize) -> bool {
        self.cavity.clear(self.of.net.face.len());
        self.cavity.add_node(&self.of, node);
        loop {
            if !self.cavity.straighten(&self.of, most) {
                return false;
            }
            work::spend(REGULAR.face_work * self.cavity.faces.len() as u64);
            let Some(rim) = self.cavity.rim(&self.of) else { return false };
            let steps: Vec<usize> = rim.sides.iter().map(|s| s.len() - 1).collect();
            if irregular(&steps).is_some_and(|left| left < rim.irregular) && self.fill(&rim) {
                return true;
            }
            if !self.cavity.extend(&self.of, &rim) {
                return false;
            }
        }
    }

    /// Puts a pattern into the cavity, if its quads are good enough.
    fn fill(&mut self, rim: &Rim) -> bool {
        let net = &*self.of.net;
        let place = |n: &u32| net.xy[*n as usize];
        let sides: Vec<Vec<DVec2>> = rim.sides.iter().map(|side| side.iter().map(place).collect()).collect();
        let Some(mut new) = pattern(&sides) else { return false };
        let ring: Vec<u32> = rim.sides.iter().flat_map(|s| s[..s.len() - 1].iter().copied()).collect();
        let mut xy: Vec<DVec2> = ring.iter().map(place).collect();
        let border = xy.len();
        xy.append(&mut new.xy);
        relax(&mut xy, border, &new);
        let old = self.cavity.faces.iter().map(|f| net.face[*f as usize].map(|n| net.xy[n as usize]));
        let (mut least, mut longest) = (REGULAR.min_quality, self.input.always);
        for p in old {
            least = least.min(least_sine(p));
            (0..4).for_each(|k| longest = longest.max(p[k].distance(p[(k + 1) % 4])));
        }
        let shortest = REGULAR.min_side * ring.iter().map(|n| net.size[*n as usize]).fold(f64::INFINITY, f64::min);
        let is_good = new.faces.iter().all(|f| {
            let p = f.map(|n| xy[n as usize]);
            let fits = |k: usize| (shortest..=longest).contains(&p[k].distance(p[(k + 1) % 4])) || f[k].max(f[(k + 1) % 4]) < border as u32;
            least_sine(p) >= least && (0..4).all(fits)
        });
        if is_good {
            let content = Content { faces: &self.cavity.faces, inner: &rim.inner, ring: &ring, new: &new.faces, xy: &xy[border..] };
            self.of.replace(&content, &self.input.plane, self.input.field);
        }
        is_good
    }
}

/// Moves the nodes of a pattern to the means of their neighbours.
fn relax(xy: &mut [DVec2], border: usize, new: &Pattern) {
    for _ in 0..REGULAR.sweeps {
        let mut sums = vec![(DVec2::ZERO, 0.0); xy.len() - border];
        for f in &new.faces {
            for k in 0..4 {
                let (a, b) = (f[k] as usize, f[(k + 1) % 4] as usize);
                // Sides inside are seen from both faces.
                for (n, other) in [(a, b), (b, a)] {
                    if let Some(sum) = n.checked_sub(border).and_then(|n| sums.get_mut(n)) {
                        *sum = (sum.0 + xy[other], sum.1 + 1.0);
                    }
                }
            }
        }
        xy[border..].iter_mut().zip(sums).for_each(|(xy, (sum, n))| *xy = sum / n);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::chart::parametric_surface::UniformSize;
    use glam::DVec3;

    /// Rows and columns of squares, in which one row ends between a node with three and one with five quads, and another one begins beside it.
    fn flawed(n: u32) -> Net {
        let mut net = Net::default();
        let node = |i: u32, j: u32| j * (n + 1) + i;
        for j in 0..=n {
            for i in 0..=n {
                net.xy.push(DVec2::new(f64::from(i), f64::from(j)));
            }
        }
        for j in 0..n {
            for i in 0..n {
                net.face.push([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
            }
        }
        // The side between two quads is put elsewhere across their hexagon.
        let (a, b) = ((n / 2 * n + n / 2) as usize, (n / 2 * n + n / 2 + 1) as usize);
        let (i, j) = (n / 2, n / 2);
        net.face[a] = [node(i, j), node(i + 1, j), node(i + 2, j), node(i, j + 1)];
        net.face[b] = [node(i + 2, j), node(i + 2, j + 1), node(i + 1, j + 1), node(i, j + 1)];
        net.p = net.xy.iter().map(|xy| xy.extend(0.0)).collect();
        net.normal = vec![DVec3::Z; net.p.len()];
        net.size = vec![1.0; net.p.len()];
        net
    }

    #[test]
    fn a_flaw_is_filled_and_the_border_stays() {
        let mut net = flawed(9);
        // Nodes of the border are the first ones of a net.
        let border: Vec<usize> = (0..100).filter(|k| [0, 9].contains(&(k % 10)) || [0, 9].contains(&(k / 10))).collect();
        let order: Vec<usize> = border.iter().copied().chain((0..100).filter(|k| !border.contains(k))).collect();
        let place = |n: u32| order.iter().position(|k| *k == n as usize).unwrap() as u32;
        net.face.iter_mut().flatten().for_each(|n| *n = place(*n));
        net.xy = order.iter().map(|k| net.xy[*k]).collect();
        net.p = order.iter().map(|k| net.p[*k]).collect();
        net.fixed = border.len() as u32;
        let fixed = net.xy[..border.len()].to_vec();
        let odd = |net: &mut Net| {
            let of = EditableNet::new(net);
            (of.net.fixed..of.net.p.len() as u32).filter(|n| of.is_irregular(*n)).count()
        };
        assert_eq!(odd(&mut net), 4);
        let input = RegularInput {
            plane: Spot { p: DVec3::ZERO, dx: DVec3::X, dy: DVec3::Y },
            field: &UniformSize(1.0),
            always: 2.0,
            has_lines: false,
        };
        assert!(regularize(&mut net, &input, &Job::default()).unwrap());
        assert_eq!((odd(&mut net), net.face.len()), (0, 81));
        assert_eq!(net.xy[..border.len()], fixed);
        assert!(!regularize(&mut net, &input, &Job::default()).unwrap());
    }
}
