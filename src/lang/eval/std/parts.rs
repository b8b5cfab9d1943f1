//! Imported parts: their faces, chosen by name, colour and kind, and what they measure.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::ValueFault;
use crate::base::origin::Origin;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::kinds::Faces;
use crate::lang::eval::std::measures::{area_of, box_of, told};
use crate::lang::values::conversions::{Area, Length, Point, Volume};
use crate::lang::values::part::PartValue;
use crate::lang::values::value::{BodyKind, ShellValue, Value};
use crate::model::measure;
use crate::surface::Surface;
use crate::surface::analysis::recognize::SimpleForm;
use crate::{builtins, fields};

/// Those of some faces whose form is wanted.
fn of_form(cx: &mut Cx, faces: Vec<Surface>, wanted: impl Fn(Option<SimpleForm>) -> bool) -> Result<Vec<Surface>, Halt> {
    let tolerance = cx.tolerance()?;
    let mut found = Vec::new();
    for face in faces {
        cx.steps(1)?;
        if wanted(face.simple_form(&tolerance)) {
            found.push(face);
        }
    }
    Ok(found)
}

/// Whether a radius is the wanted one, within the tolerance; every one is where none is said.
fn fits(cx: &Cx, wanted: Option<Length>) -> Result<impl Fn(f64) -> bool + use<>, Halt> {
    let near = cx.tolerance()?.point;
    Ok(move |radius: f64| wanted.as_ref().is_none_or(|wanted| (wanted.0 - radius).abs() <= near))
}

/// Red, green and blue of `#ff8000`.
fn hex(text: &str) -> Option<[f64; 3]> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii())?;
    let mut rgb = [0.0; 3];
    for (k, slot) in rgb.iter_mut().enumerate() {
        *slot = f64::from(u8::from_str_radix(&digits[2 * k..2 * k + 2], 16).ok()?) / 255.0;
    }
    Some(rgb)
}

/// What the volume of a part, or its centre, is of.
fn volumes(cx: &mut Cx, part: &PartValue) -> Result<(f64, DVec3), Halt> {
    let shells = closed_of(cx, part.solids(), (part.name.clone(), part.file.origin))?;
    let (volume, moment) = enclosed(cx, shells)?;
    if volume > 0.0 { Ok((volume, moment / volume)) } else { Err(nothing()) }
}

/// Shells of some shells and surfaces: solids as they are, and closed ones where all others are, else the rest together. Many programs write
/// each face as a shell of its own, and what closes then are all of them: a whole sphere among them may be a cavity.
fn closed_of(cx: &mut Cx, things: Vec<Value>, (name, origin): (Arc<str>, Origin)) -> Result<Vec<Arc<ShellValue>>, Halt> {
    let module = cx.module();
    let (mut closed, mut open, mut surfaces) = (Vec::new(), Vec::new(), Vec::new());
    for thing in things {
        match thing {
            Value::Surface(surface) => surfaces.push(surface),
            Value::Shell(shell) if shell.body == Some(BodyKind::Solid) || cx.glued(module, &shell)?.shell.closed => closed.push(shell),
            Value::Shell(shell) => {
                surfaces.extend(shell.surfaces.iter().cloned());
                open.push(shell);
            }
            _ => {}
        }
    }
    if !open.is_empty() {
        let (solids, others): (Vec<_>, Vec<_>) = closed.into_iter().partition(|shell| shell.body != Some(BodyKind::Shell));
        surfaces.extend(others.iter().flat_map(|shell| shell.surfaces.iter().cloned()));
        open.extend(others);
        closed = solids;
    }
    match open.as_slice() {
        [one] if surfaces.len() == one.surfaces.len() => closed.push(one.clone()),
        _ if surfaces.is_empty() => {}
        shells => {
            let snap = shells.iter().filter_map(|shell| shell.snap).max_by(|a, b| a.0.total_cmp(&b.0));
            let body = Some(BodyKind::Solid);
            closed.push(Arc::new(ShellValue { name, module, origin, surfaces, snap, imprint: None, flip: false, body }));
        }
    }
    Ok(closed)
}

/// The volume that closed shells enclose, and its moment.
fn enclosed(cx: &mut Cx, shells: Vec<Arc<ShellValue>>) -> Result<(f64, DVec3), Halt> {
    let (mut volume, mut moment) = (0.0, DVec3::ZERO);
    for shell in shells {
        let solid = cx.solid(&shell)?;
        let own = told(cx, "the volume", shell.origin, (solid.volume.abs(), solid.error));
        volume += own;
        moment += solid.centroid * own;
    }
    Ok((volume, moment))
}

fn nothing() -> Halt {
    ValueFault::OutsideRange { argument: "of", found: "a part without faces".to_owned(), range: "a part with faces".to_owned() }.into()
}

builtins! {
    /// Faces that are planes.
    ///
    /// The form counts, within the tolerance, and not how the face is written: a spline surface that is flat is a plane.
    /// ```loft
    /// curve base = circle(center: (0, 0, 0), radius: 5mm)
    /// surface wall = extrude(base, by: (0, 0, 20mm))
    /// surface floor = plane(base)
    /// let flat = len([wall, floor].planes) // => 1
    /// ```
    fn planes(
        /// Surfaces, or a part.
        faces: Vec<Surface>,
    ) -> Vec<Surface> = |cx, faces| of_form(cx, faces, |form| matches!(form, Some(SimpleForm::Plane)));

    /// Faces that are round cylinders, all or those of one radius.
    ///
    /// ```loft
    /// curve base = circle(center: (0, 0, 0), radius: 5mm)
    /// surface wall = extrude(base, by: (0, 0, 20mm))
    /// let bores = len([wall].cylinders(radius: 5mm)) // => 1
    /// ```
    fn cylinders(
        /// Surfaces, or a part.
        faces: Vec<Surface>,
        /// The radius wanted, within the tolerance.
        radius: Option<Length>,
    ) -> Vec<Surface> = |cx, faces, radius| {
        let fits = fits(cx, radius)?;
        of_form(cx, faces, |form| matches!(form, Some(SimpleForm::Cylinder { radius, .. }) if fits(radius)))
    };

    /// Faces that are round cones.
    ///
    /// ```loft
    /// let axis = line((0, 0, 0), (0, 0, 1m))
    /// surface funnel = revolve(line((2m, 0, 0), (1m, 0, 1m)), axis: axis)
    /// let tapered = len([funnel].cones) // => 1
    /// ```
    fn cones(
        /// Surfaces, or a part.
        faces: Vec<Surface>,
    ) -> Vec<Surface> = |cx, faces| of_form(cx, faces, |form| matches!(form, Some(SimpleForm::Cone)));

    /// Faces that are spheres, all or those of one radius.
    ///
    /// ```loft
    /// let axis = line((0, 0, 0), (0, 0, 1m))
    /// let half = arc((0, 0, -1m), (0, 0, 1m), through: (1m, 0, 0))
    /// surface ball = revolve(half, axis: axis)
    /// let balls = len([ball].spheres(radius: 1m)) // => 1
    /// ```
    fn spheres(
        /// Surfaces, or a part.
        faces: Vec<Surface>,
        /// The radius wanted, within the tolerance.
        radius: Option<Length>,
    ) -> Vec<Surface> = |cx, faces, radius| {
        let fits = fits(cx, radius)?;
        of_form(cx, faces, |form| matches!(form, Some(SimpleForm::Sphere { radius, .. }) if fits(radius)))
    };

    /// Faces that are ring tori, all or those of one tube radius.
    ///
    /// Fillets of round edges have this form.
    /// ```loft
    /// let axis = line((0, 0, 0), (0, 0, 1m))
    /// surface ring = revolve(circle(center: (3m, 0, 0), radius: 1m, normal: (0, 1, 0)), axis: axis)
    /// let rings = len([ring].tori(radius: 1m)) // => 1
    /// ```
    fn tori(
        /// Surfaces, or a part.
        faces: Vec<Surface>,
        /// The radius of the tube wanted, within the tolerance.
        radius: Option<Length>,
    ) -> Vec<Surface> = |cx, faces, radius| {
        let fits = fits(cx, radius)?;
        of_form(cx, faces, |form| matches!(form, Some(SimpleForm::Torus { minor, .. }) if fits(minor)))
    };

    /// Faces that are not planes, cylinders, cones, spheres or ring tori.
    ///
    /// ```loft
    /// surface saddle = coons(line((0, 0, 0), (1m, 0, 0)), line((1m, 0, 0), (1m, 1m, 1m)), line((1m, 1m, 1m), (0, 1m, 0)),
    ///   line((0, 1m, 0), (0, 0, 0)))
    /// let free = len([saddle].others) // => 1
    /// ```
    fn others(
        /// Surfaces, or a part.
        faces: Vec<Surface>,
    ) -> Vec<Surface> = |cx, faces| of_form(cx, faces, |form| form.is_none());

    /// Faces that have this name in their file.
    ///
    /// A number that the import put behind a name does not count: `named("rim")` finds `rim` and `rim_2`.
    /// ```loft
    /// curve base = circle(center: (0, 0, 0), radius: 5mm)
    /// surface lid = plane(base)
    /// let rims = len([lid].named("rim")) // => 0
    /// ```
    fn named(
        /// Faces of a part, or the part.
        faces: Vec<Surface>,
        /// The file's name.
        name: Arc<str>,
    ) -> Vec<Surface> = |cx, faces, name| {
        let fits = |own: &str| {
            let rest = own.strip_prefix(&*name);
            rest.is_some_and(|rest| rest.is_empty() || rest.strip_prefix('_').is_some_and(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit())))
        };
        Ok(faces.into_iter().filter(|face| cx.said_of(face).is_some_and(|said| fits(&said.name))).collect())
    };

    /// Faces that have this colour in their file.
    ///
    /// The colour is the file's name of it, or red, green and blue as `"#ff8000"`.
    /// ```loft
    /// curve base = circle(center: (0, 0, 0), radius: 5mm)
    /// surface lid = plane(base)
    /// let painted = len([lid].colored("#ff8000")) // => 0
    /// ```
    fn colored(
        /// Faces of a part, or the part.
        faces: Vec<Surface>,
        /// Name of the colour, or `#` and its red, green and blue in two hexadecimal digits each.
        color: Arc<str>,
    ) -> Vec<Surface> = |cx, faces, color| {
        let wanted = hex(&color);
        let near = |rgb: [f64; 3]| wanted.is_some_and(|wanted| rgb.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= 0.5 / 255.0));
        let fits = |face: &Surface| {
            let said = cx.said_of(face)?;
            let (name, rgb) = said.color.as_ref()?;
            Some(**name == *color || near(*rgb))
        };
        Ok(faces.into_iter().filter(|face| fits(face) == Some(true)).collect())
    };
}

fields! {
    /// The faces of a part, in file order; `part.faces[12]` is how messages name one.
    ///
    /// A face that could not be used is not among them. The list may be narrowed: `part.faces.cylinders(radius: 5mm)`.
    fn faces(of: Arc<PartValue>) -> Vec<Surface> = |_, of| Ok(of.faces.clone());
    /// Area of all faces of a part.
    fn area(of: Arc<PartValue>) -> Area = |cx, of| Ok(area_of(cx, &of.faces));
    /// Volume of all solids of a part. Where the file has none it is that of the closed shells that its faces form.
    ///
    /// Shells of the file that are open, of a face each perhaps, count together.
    fn volume(of: Arc<PartValue>) -> Volume = |cx, of| Ok(Volume(volumes(cx, &of)?.0));
    /// Centre of the volume of the solids of a part. Where they enclose none it is that of the area of its faces.
    fn centroid(of: Arc<PartValue>) -> Point = |cx, of| match volumes(cx, &of) {
        Ok((_, centroid)) => Ok(Point(centroid)),
        Err(Halt::Fault(_)) if !of.faces.is_empty() => Ok(Point(measure::sheet(&of.faces).centroid)),
        Err(other) => Err(other),
    };
    /// The smallest box along the axes, to 1e-6 of its diagonal. Its members are `min`, `max`, `size` and `diagonal`.
    ///
    /// Where thousands of places are equally extreme it may be larger: W227 says by how much at most. It contains every point.
    fn bbox(of: Arc<PartValue>) -> Value = |cx, of| boxed(cx, &of.faces);
    /// The smallest box along the axes around surfaces, to 1e-6 of its diagonal. Its members are `min`, `max`, `size` and `diagonal`.
    ///
    /// Where thousands of places are equally extreme it may be larger: W227 says by how much at most. It contains every point.
    fn bbox(of: Vec<Surface>) -> Value = |cx, of| boxed(cx, &of);
    /// Area of surfaces together.
    fn area(of: Vec<Surface>) -> Area = |cx, of| Ok(area_of(cx, &of));
    /// Volume that surfaces and shells enclose together.
    ///
    /// It is that of each closed shell, and of all others glued together. Where these stay open it is E656.
    fn volume(of: Faces) -> Volume = |cx, of| {
        let origin = cx.origin();
        let shells = closed_of(cx, of.members(), ("".into(), origin))?;
        Ok(Volume(enclosed(cx, shells)?.0))
    };
}

fn boxed(cx: &mut Cx, faces: &[Surface]) -> Result<Value, Halt> {
    if faces.is_empty() { Err(nothing()) } else { Ok(box_of(cx, faces)) }
}
