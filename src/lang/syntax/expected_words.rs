//! What the grammar would have gone on with, in words.

use crate::lang::syntax::Rule;

/// Whether a value is wanted: a whole one, or an operand.
pub(crate) fn is_value(rules: &[Rule]) -> bool {
    rules.iter().any(|r| matches!(r, Rule::expr | Rule::things | Rule::slice | Rule::number))
}

/// A text of at most forty characters.
pub(crate) fn shortened(text: &str) -> String {
    if text.chars().count() <= 40 { text.to_owned() } else { text.chars().take(39).chain(['…']).collect() }
}

/// Names of rules for people, each once, joined. Where a list may go on or end, what could lengthen its last item goes
/// without saying.
pub(crate) fn words(rules: &[Rule]) -> String {
    let closes = rules.iter().any(|r| {
        matches!(r, Rule::comma | Rule::rpar | Rule::rbracket | Rule::rbrace | Rule::eq | Rule::colon)
            || matches!(r, Rule::kw_of | Rule::kw_to | Rule::kw_then | Rule::kw_else | Rule::kw_in | Rule::kw_as)
    });
    let goes_on = closes || rules.contains(&Rule::infix);
    let value = is_value(rules);
    let silent = |rule: Rule| match rule {
        Rule::name | Rule::word => rules.contains(&Rule::number),
        Rule::infix => closes,
        Rule::args => goes_on && !rules.contains(&Rule::kw_as),
        Rule::colon => rules.contains(&Rule::comma),
        Rule::string | Rule::label => value,
        Rule::EOI => closes,
        _ => false,
    };
    let mut words: Vec<(u8, &str)> = Vec::new();
    for word in rules.iter().filter(|&&rule| !silent(rule)).filter_map(|&rule| word(rule)) {
        let rank = if word.starts_with("the end") { 2 } else { u8::from(word != "an operator") };
        if !words.iter().any(|&(_, w)| w == word) {
            words.push((rank, word));
        }
    }
    words.sort_by_key(|&(rank, _)| rank);
    match words.as_slice() {
        [] => "something else".to_owned(),
        [(_, one)] => (*one).to_owned(),
        [most @ .., (_, last)] => format!("{} or {last}", most.iter().map(|(_, w)| *w).collect::<Vec<_>>().join(", ")),
    }
}

/// What people call a rule; none for what says nothing.
fn word(rule: Rule) -> Option<&'static str> {
    Some(match rule {
        Rule::EOI => "the end of the declaration",
        Rule::expr | Rule::things | Rule::slice | Rule::arg | Rule::target | Rule::number => "a value",
        Rule::infix => "an operator",
        Rule::name | Rule::word => "a name",
        Rule::type_ => "a type",
        Rule::string => "a string",
        Rule::args | Rule::lpar | Rule::parameters => "`(`",
        Rule::comma => "`,`",
        Rule::colon => "`:`",
        Rule::eq => "`=`",
        Rule::rpar => "`)`",
        Rule::rbracket => "`]`",
        Rule::rbrace => "`}`",
        Rule::lbrace | Rule::settings | Rule::mesh_settings => "`{`",
        Rule::interpolation_end => "`}`",
        Rule::kw_of => "`of`",
        Rule::kw_in | Rule::let_in => "`in`",
        Rule::kw_to => "`to`",
        Rule::kw_as => "`as`",
        Rule::kw_then => "`then`",
        Rule::kw_else => "`else`",
        Rule::for_clause | Rule::kw_for => "`for`",
        Rule::if_clause => "`if`",
        Rule::setting => "a setting",
        Rule::clause => "`on`, `near` or `in`",
        Rule::unit_name => "a unit",
        Rule::kw_curve => "`curve`",
        Rule::pair => "a field",
        Rule::parameter => "a parameter",
        _ => return None,
    })
}
