//! The one table of all codes: what a report is called, in which version it came, and its page.
//!
//! The first digit is the family: 1 syntax, 2 names, values and units, 3 arguments, 4 curves, 5 network and chains,
//! 6 surfaces and model, 7 mesh, 8 files, 9 checks and ourselves. The letter is the severity: E error, W warning, N
//! note; a number is used once whatever its letter, and a code never changes its meaning.

/// One code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodeInfo {
    /// For example `E501`.
    pub code: &'static str,
    /// Its name in words with hyphens.
    pub slug: &'static str,
    /// What it means, in one line.
    pub title: &'static str,
    /// The first version that reports it; none when a later one will.
    pub since: Option<&'static str>,
    /// Its page in Markdown: a small broken script, its message and how to fix it.
    pub page: &'static str,
}

macro_rules! codes {
    ($($when:ident $code:literal, $slug:literal, $title:literal;)+) => {
        /// All codes, by family.
        pub const CODES: &[CodeInfo] = &[$( codes!(@$when $code, $slug, $title) ),+];
    };
    (@now $code:literal, $slug:literal, $title:literal) => {
        CodeInfo {
            code: $code,
            slug: $slug,
            title: $title,
            since: Some("0.1"),
            page: include_str!(concat!("../../../docs/codes/", $code, ".md")),
        }
    };
    (@later $code:literal, $slug:literal, $title:literal) => {
        CodeInfo {
            code: $code,
            slug: $slug,
            title: $title,
            since: None,
            page: concat!("# ", $code, ": ", $title, "\n\nNot in this version.\n"),
        }
    };
}

codes! {
    now "E101", "bracket-open", "a bracket is never closed";
    now "E102", "unexpected", "something else is expected here";
    now "E103", "string-open", "a string has no end";
    now "E104", "comment-open", "a comment has no end";
    now "E105", "two-on-a-line", "two declarations on one line";
    now "E106", "no-such-keyword", "a declaration starts with no known keyword";
    now "E107", "malformed-number", "a number or unit is malformed";
    now "E108", "let-without-in", "a local `let` has no `in`";
    now "E109", "nested-too-deep", "brackets or operators are nested too deep";
    now "E110", "source-too-large", "the script is too large";
    now "E201", "not-defined", "a name is not defined";
    now "E202", "defined-twice", "a name is defined twice";
    now "E203", "cycle", "declarations depend on each other in a circle";
    now "E211", "wrong-kind", "a value of the wrong kind or dimension";
    now "E212", "bare-number", "a bare number beside a quantity";
    now "E213", "no-such-choice", "a word is not one of the choices";
    now "E214", "no-such-field", "a value has no such field";
    now "E215", "index-outside", "an index lies outside its list";
    now "E216", "calls-too-deep", "functions call each other too deep";
    now "E217", "limit", "a list or the work of a run exceeds its limit";
    now "E218", "param-outside", "a param lies outside what it allows";
    now "E219", "no-such-param", "there is no such param";
    now "W220", "unit-power", "`2m^2` is the square of 2m, not 2m2";
    now "E221", "equality-without-within", "two quantities are compared by `==` without `within`";
    now "W222", "tolerance-of-module", "a module's own tolerance has no effect";
    now "W223", "snap-moves-far", "`snap` moves an end by more than a hundredth of its curve";
    now "W224", "group-not-meshed", "no exported mesh has a member of a group";
    now "W225", "points-merged", "scattered points are given twice";
    now "W226", "points-exceeded", "a surface overshoots its scattered points";
    now "W227", "loose-box", "a box may be too large";
    now "W228", "rough-measure", "a measure is known to few digits";
    now "W229", "mixed-scripts", "a name has letters that look like those of another script";
    now "E230", "not-in-this-version", "a word of a later version";
    now "E301", "argument-missing", "an argument is missing";
    now "E302", "too-many-arguments", "too many arguments";
    now "E303", "no-such-argument", "a function has no such argument";
    now "E304", "given-twice", "an argument is given twice";
    now "E305", "exclusive-arguments", "arguments exclude each other";
    now "E306", "value-outside", "a value lies outside its range";
    now "E401", "curve-zero-length", "a curve would have no length";
    now "E402", "too-few-points", "a curve has too few points";
    now "E403", "curve-duplicate-points", "neighbouring points of a curve coincide";
    now "E404", "arc-collinear", "three points of an arc lie on one line";
    now "E405", "conic-rho", "the `rho` of a conic lies outside 0 … 1";
    now "E406", "knot-decreasing", "knots decrease or do not fit the points";
    now "E407", "weight-not-positive", "a weight is not positive";
    now "E408", "non-finite", "a result is not a finite number";
    now "E409", "tangent-zero", "a tangent has no direction";
    now "E410", "arc-length-stalled", "an arc length cannot be found to the tolerance";
    now "E411", "angle-zero", "an angle is zero";
    now "E412", "angle-too-large", "an angle is more than a full turn";
    now "E413", "did-not-converge", "an iteration did not converge";
    now "E414", "corner-too-narrow", "a rounding or cut does not fit a corner";
    now "E415", "no-corner", "a curve has no corner there";
    now "E416", "corner-not-flat", "the sides of a corner do not lie in a plane";
    now "E417", "no-end-to-extend", "a curve or surface has no end that could be extended";
    now "E418", "extended-too-far", "a curve or surface does not go on that far";
    now "E501", "ends-miss", "two ends miss each other";
    now "E502", "boundary-open", "a boundary or loop does not close";
    now "E503", "chain-broken", "links of a chain do not join";
    now "E504", "chain-repeats-link", "a chain runs over a link twice";
    now "E505", "chain-ambiguous", "a chain can run in more than one way";
    now "E506", "node-cluster-ambiguous", "it is ambiguous which nearby points are one node";
    now "E507", "no-meeting", "two things do not meet";
    now "E508", "several-meetings", "two things meet more than once";
    now "E509", "shared-run", "curves share a run where one meeting is wanted";
    now "E510", "in-use", "something to be removed is still used";
    now "E511", "snap-cannot-move", "two ends that `snap` cannot move";
    now "N512", "shared-run-noted", "two curves share a run";
    now "N513", "moved-by-snap", "an end was moved by `snap`";
    now "W514", "near-miss", "curves nearly meet";
    now "E601", "flow-unknown", "the flow of a surface cannot be found";
    now "E602", "grid-incomplete", "curves of a grid do not all cross";
    now "E603", "grid-double", "curves of a grid cross twice";
    now "E604", "grid-not-monotone", "curves of a grid cross in different orders";
    now "E605", "family-crosses", "curves of one family cross each other";
    now "W606", "patch-singular", "a patch has a point without a normal";
    now "W607", "patch-folded", "a patch folds over";
    now "N608", "transfinite-oscillation", "a transfinite surface may oscillate between its curves";
    now "N609", "end-trimmed", "the end of a curve was trimmed to the border";
    now "E611", "loop-self-intersects", "a loop crosses itself";
    now "E612", "loop-outside", "a hole lies outside its outer loop or cuts it";
    now "E613", "loop-outside-surface", "a loop leaves its surface";
    now "W614", "sliver-patch", "a patch is a sliver";
    now "N615", "shell-open", "a shell has free edges";
    now "E616", "shell-not-orientable", "the faces of a shell cannot be oriented alike";
    now "E617", "shell-nonmanifold", "more than two faces share an edge";
    now "E618", "not-adjacent", "two things share no edge";
    now "E621", "axis-not-straight", "an axis is not a straight curve";
    now "E622", "generatrix-on-axis", "a generatrix lies on its axis";
    now "E623", "generatrix-crosses-axis", "a generatrix crosses its axis";
    now "E624", "sweep-degenerate", "a sweep or extrusion has no area";
    now "E631", "sections-not-parallel", "sections are not parallel";
    now "E632", "axis-off-section", "the axis misses a section";
    now "E633", "section-not-normal", "a section is not normal to its guide";
    now "E634", "guide-misses-station", "a guide misses a station";
    now "E635", "guide-doubles-back", "a guide doubles back";
    now "E636", "guide-cusp", "a guide has a cusp";
    now "E637", "main-guide-on-axis", "the main guide touches the axis";
    now "N638", "guide-extended", "a guide was extended";
    now "W639", "sweep-self-intersects", "a sweep crosses itself";
    now "E640", "sections-different-guides", "sections touch different guides";
    now "E641", "net-incomplete", "a net of profiles and guides is incomplete";
    now "E642", "sections-cross", "sections cross each other";
    now "E643", "guide-order-differs", "guides meet sections in different orders";
    now "W644", "section-scaled", "a section was scaled to its guides";
    now "W645", "station-ripples", "a station of a sweep bends to and fro";
    now "W646", "law-missed", "a sweep is off its law between stations";
    now "W651", "grid-uneven", "the points of a grid are unevenly spaced";
    now "E652", "pole-tangent-parallel", "tangents at a pole are parallel";
    now "E653", "corner-tangent-parallel", "tangents at a corner are parallel";
    now "E654", "border-not-resolved", "a border cannot be resolved";
    now "E655", "plane-not-flat", "the boundary of a plane is not flat";
    now "E656", "shell-not-closed", "a measure needs a closed shell";
    now "E657", "surfaces-coincide", "surfaces run along each other";
    now "E658", "meets-without-end", "unbounded planes meet in an infinite line";
    now "E659", "cut-open", "a curve that should divide a surface ends inside it";
    now "E660", "keep-off", "the point to keep is in no part of the surface";
    now "E661", "loops-meet", "two holes of a face meet";
    now "E662", "hole-in-hole", "a hole lies inside another one";
    now "E663", "curve-given-twice", "a curve is given twice";
    now "W664", "offset-folds", "an offset folds over";
    now "E665", "points-on-one-line", "points that should span a surface lie on one line";
    now "E666", "imprint-overlap", "faces to be joined overlap";
    now "W667", "faces-touch", "faces of a mesh touch without sharing nodes";
    now "W668", "points-steep", "scattered points rise very steeply";
    now "W669", "surface-crosses-itself", "a surface crosses itself";
    now "E670", "offset-not-smooth", "a surface to be offset is not smooth";
    now "E671", "wall-edge", "the walls of two faces do not meet at their edge";
    now "E672", "set-in-part", "a set would contain only a part of a curve";
    now "E673", "blend-too-large", "a ball is too large for the edge that it rounds";
    now "E674", "blend-no-edge", "two surfaces have no edge that can be rounded";
    now "E675", "points-over-points", "scattered points lie above one another";
    now "E676", "no-net", "a surface has no B-spline form of its own";
    now "N677", "near-its-curves", "a surface deviates from its curves within a limit";
    now "W678", "noise-understated", "points scatter more than was stated";
    now "W679", "point-off", "a point is far off the run of its neighbours";
    now "E680", "fill-not-beside", "a face to be continued lies along no border of the hole";
    now "W681", "fill-corner", "faces beside a hole do not agree at a corner";
    now "W682", "fill-misses", "a fill is off what lies beside it";
    now "E683", "fill-folds", "the borders of a hole cross as seen from above";
    now "W701", "rule-decides-nothing", "a rule has no effect";
    now "E702", "counts-differ", "counts differ on opposite sides";
    now "E703", "count-too-coarse", "a count is too coarse for a limit";
    now "E704", "only-quads-impossible", "`elements: quads` is impossible here";
    now "E705", "face-cannot-be-mapped", "a face cannot be mapped";
    now "W706", "rule-overridden", "a rule is overridden by an equal one";
    now "E707", "below-min-size", "a size or limit is below `min_size`";
    now "E711", "edge-mismatch", "borders of neighbouring faces are too far apart";
    now "N712", "edge-too-short", "an edge became a corner";
    now "E713", "cdt-constraint-crosses", "borders of a face cross";
    now "E714", "face-empty", "a face has nothing inside";
    now "E715", "element-inverted", "an element is inverted";
    now "E716", "quadtree-too-deep", "a quadtree is too deep";
    later "E717", "tessellation-limit", "a tessellation exceeds its limit";
    now "E718", "face-folded", "a face folds over";
    now "E720", "closes-too-near", "a face closes on itself more narrowly than its elements";
    now "E721", "cuts-too-near", "curves that divide a surface are too close together";
    now "E722", "no-row", "surfaces to be joined do not follow one another";
    now "W724", "sharp-elements", "a mesh has elements with sharp angles";
    now "W725", "too-small-for-mesh", "something is too small for a mesh";
    now "W726", "faces-unusable", "faces of a file could not be used";
    now "W728", "empty-selection", "a selection is empty";
    now "W729", "holds-of-nothing", "a check tests an empty list";
    now "W730", "curve-leaves-face", "a curve of a mesh leaves the face that it lies on";
    now "E801", "cannot-read", "a file cannot be read";
    now "E802", "outside-folders", "a path leaves the allowed folders";
    now "E803", "malformed-data", "a table or entity is malformed";
    now "E804", "no-such-format", "there is no such file format";
    now "E805", "export-unsupported", "a format cannot hold this";
    now "W806", "left-out", "a format leaves something out";
    now "W807", "set-renamed", "a set was renamed for a format";
    now "E808", "cannot-write", "a file cannot be written";
    now "E809", "modules-cycle", "modules import each other";
    now "W810", "entity-skipped", "an entity of a file was skipped or repaired";
    now "E811", "file-too-large", "a file is too large";
    now "E812", "one-file-twice", "several outputs are one file";
    now "E813", "output-over-input", "an output would replace a file that is read";
    now "W814", "body-twice", "a body stands twice in the same place";
    now "E815", "little-read", "little of a file could be read";
    now "E901", "check-failed", "a check failed";
    now "E902", "golden-differs", "a golden differs";
    now "E903", "raised", "the script reports an error";
    now "E904", "incomplete-part", "what is exported lacks faces of its file";
    now "E999", "bug", "a bug in loft";
}

/// The code with this text, whatever its case.
pub fn find(code: &str) -> Option<&'static CodeInfo> {
    CODES.iter().find(|c| c.code.eq_ignore_ascii_case(code))
}

/// The page of a code: what it means, a small broken script, its message and how to fix it.
pub fn explain(code: &str) -> Option<&'static str> {
    find(code).map(|c| c.page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_code_stands_once_and_in_order() {
        assert!(CODES.windows(2).all(|w| w[0].code[1..] < w[1].code[1..]));
        let mut slugs: Vec<&str> = CODES.iter().map(|c| c.slug).collect();
        slugs.sort_unstable();
        assert!(slugs.windows(2).all(|w| w[0] != w[1]));
        assert_eq!(find("e501").map(|c| c.slug), Some("ends-miss"));
        assert!(explain("E000").is_none());
    }

    #[test]
    fn pages_begin_with_their_title() {
        for info in CODES {
            let first = info.page.lines().next().unwrap_or("");
            assert_eq!(first, format!("# {}: {}", info.code, info.title));
        }
    }
}
