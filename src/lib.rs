//! `lofting` turns curves, or a short text that describes a model, into exact surfaces, an analysis-ready mesh and the files a solver
//! reads.
//!
//! # From a script
//!
//! A [`Script`] is the text of a model in the language `loft`, with the files that it may import, in memory or in a folder.
//! [`Script::run`] gives a [`Model`]: its curves, surfaces, meshes, checks and outputs. It touches no file that it is not given.
//!
//! ```
//! let script = "
//!     units m
//!     param span = 50m in 20m to 80m
//!     curve south = arc((-16, 0, 19), (16, 0, 19), through: (0, 0, 25))
//!     curve north = move(south, by: (0, span, 0))
//!     surface vault = ruled(south, north)
//!     mesh fine of vault { elements: quads, size: 2m }
//!     check fine.area == vault.area within 1%
//!     export fine to \"vault.inp\"
//! ";
//! let model = lofting::Script::from_str(script).set("span", "60m").run()?;
//! let mesh = model.mesh("fine").ok_or("no mesh")?;
//! assert_eq!(mesh.quads().len(), 18 * 30);
//! assert!(model.output("vault.inp").and_then(|deck| deck.text()).is_some_and(|deck| deck.contains("*ELEMENT")));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # From Rust
//!
//! [`Curve`]s meet in a [`Network`] and carry [`Surface`]s; a [`Model`] holds them under their names, and a [`MeshPlan`] asks for a
//! [`Mesh`] of it. Points are three numbers in model units; what counts as one point is said once, by a [`Tolerance`].
//!
//! ```
//! use lofting::{Curve, Elements, MeshPlan, Model, Surface, Tolerance};
//!
//! let tolerance = Tolerance::new(1e-5, 10.0); // Points nearer than that are one, in a model ten across.
//! let south = Curve::line((0.0, 0.0, 0.0), (6.0, 0.0, 0.0))?.named("south");
//! let north = Curve::arc((0.0, 8.0, 0.0), (6.0, 8.0, 0.0), (3.0, 8.0, 2.0))?.named("north");
//! let west = Curve::line(south.start(), north.start())?;
//! let east = Curve::line(south.end(), north.end())?;
//! let roof = Surface::coons([&south, &east, &north, &west], &tolerance)?.named("roof");
//!
//! let model = Model::new([], [&roof], &tolerance)?.with_unit("m")?;
//! let mesh = MeshPlan::new("roof").elements(Elements::Quads).size(0.5).count("south", 10).mesh(&model)?;
//! assert_eq!(mesh.quads().len(), 10 * 16);
//! assert!(mesh.to_bytes("roof.vtu")?.starts_with(b"<?xml"));
//! # Ok::<(), lofting::Error>(())
//! ```
//!
//! # When something is wrong
//!
//! Everything that can fail gives an [`Error`] with a code, a sentence and, for scripts, the place. What a code means is told by
//! `loft explain E501` and in `docs/codes`. Nothing panics, and no input runs for ever: limits are checked and work is counted.
//!
//! ```
//! use lofting::Script;
//!
//! let error = Script::from_str("units mm\nlet half = widht / 2").run().unwrap_err();
//! let place = error.place().ok_or("no place")?;
//! assert_eq!((error.code(), place.line, place.column), ("E201", 2, 12));
//! assert_eq!(error.to_string(), "model.loft:2:12: E201 `widht` is not defined");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The language is told in `docs/guide` and by `loft doc`, and how the code is laid out in `docs/architecture.md`. Programs that only use
//! this library leave out the command line with `default-features = false`; the feature `parallel` works on several threads, and results
//! are the same bytes without it.

#[doc(hidden)]
pub mod base;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod draw;
#[doc(hidden)]
pub mod geometry;
#[doc(hidden)]
pub mod hydrostatics;
#[doc(hidden)]
pub mod io;
#[doc(hidden)]
pub mod lang;
mod library;
#[doc(hidden)]
pub mod mesh;
#[doc(hidden)]
pub mod model;
#[doc(hidden)]
pub mod network;
#[doc(hidden)]
pub mod session;
#[doc(hidden)]
pub mod surface;

pub use library::{Curve, Error, Mesh, MeshPlan, Model, Network, Output, Script, Surface};

#[doc(inline)]
pub use base::tolerance::Tolerance;
#[doc(inline)]
pub use mesh::{Elements, Group, Method, Quality};
#[doc(inline)]
pub use session::report::{Cell, CheckRow as Check, DiagnosticRow as Diagnostic, LabelRow as Place};
