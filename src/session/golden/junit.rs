//! Results for continuous integration, in the XML that JUnit made common.

use super::verdict::{CaseResult, Verdict};
use crate::base::xml::escaped;

/// One suite with a case for each run, in their order; ends in a line break.
pub fn text(results: &[CaseResult]) -> String {
    let count = |is: &dyn Fn(Verdict) -> bool| results.iter().filter(|r| is(r.verdict)).count();
    let errors = count(&is_error);
    let failures = count(&|v| !v.is_good() && !is_error(v));
    let counts = format!("tests=\"{}\" failures=\"{failures}\" errors=\"{errors}\"", results.len());
    let seconds: f64 = results.iter().map(|r| r.seconds).sum();
    let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    out.push_str(&format!("<testsuites name=\"loft test\" {counts} time=\"{seconds:.3}\">\n"));
    out.push_str(&format!("  <testsuite name=\"loft test\" {counts} skipped=\"0\" time=\"{seconds:.3}\">\n"));
    results.iter().for_each(|result| case(result, &mut out));
    out.push_str("  </testsuite>\n</testsuites>\n");
    out
}

/// Failures are about models, errors about files and loft itself.
fn is_error(verdict: Verdict) -> bool {
    matches!(verdict, Verdict::Unreadable | Verdict::Ended | Verdict::Bug | Verdict::Interrupted)
}

fn case(result: &CaseResult, out: &mut String) {
    let (model, case) = result.name.strip_suffix(']').and_then(|n| n.rsplit_once(" [")).unwrap_or((&result.name, "as written"));
    out.push_str(&format!("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3}\"", escaped(model), escaped(case), result.seconds));
    if result.verdict.is_good() {
        out.push_str("/>\n");
        return;
    }
    let tag = if is_error(result.verdict) { "error" } else { "failure" };
    let lines: String = result.lines.iter().map(|line| format!("{}\n", line.text(false))).collect();
    let help = result.help.as_ref().map_or(String::new(), |help| format!("  help: {help}\n"));
    let (kind, message) = (result.verdict.word(), escaped(&result.message));
    out.push_str(&format!(">\n      <{tag} type=\"{kind}\" message=\"{message}\">{}</{tag}>\n", escaped(&format!("{lines}{help}"))));
    out.push_str("    </testcase>\n");
}

#[cfg(test)]
mod tests {
    use super::super::describe::DiffLine;
    use super::*;

    #[test]
    fn xml_holds_any_text() {
        let case = |name: &str, verdict| CaseResult {
            name: name.to_owned(),
            verdict,
            message: "\"a\" < b & \u{1b}[31mc".to_owned(),
            lines: vec![DiffLine::Old("mesh <m>".to_owned())],
            help: None,
            seconds: 0.25,
        };
        let text = text(&[case("a.loft", Verdict::Passed), case("b.loft [long]", Verdict::Differs), case("c.loft", Verdict::Bug)]);
        assert!(text.contains("tests=\"3\" failures=\"1\" errors=\"1\" time=\"0.750\""), "{text}");
        assert!(text.contains("classname=\"b.loft\" name=\"long\""), "{text}");
        assert!(text.contains("message=\"&quot;a&quot; &lt; b &amp; \u{fffd}[31mc\">  - mesh &lt;m&gt;&#10;</failure>"), "{text}");
    }
}
