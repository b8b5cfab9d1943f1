//! Examples of every command: `--help` and the manual page show them.

/// A command line and what it does.
pub type Example = (&'static str, &'static str);

/// The examples of each command.
const EXAMPLES: &[(&str, &[Example])] = &[
    (
        "run",
        &[
            ("loft run roof.loft", "writes the files of the model beside it"),
            ("loft run roof.loft -o out --set span=12m", "with another value of a param, into a folder"),
            ("loft run tank.loft --table tanks.csv -o out", "once for each row of a table"),
            ("loft run roof.loft --json > roof.json", "the whole report for a program"),
        ],
    ),
    (
        "check",
        &[
            ("loft check roof.loft", "evaluates, meshes and checks, and writes nothing"),
            ("loft check *.loft --strict --quiet", "several models, warnings are errors, only what is wrong is printed"),
        ],
    ),
    ("repl", &[("loft repl roof.loft", "goes on with a script"), ("loft repl < session.txt", "the same from a file")]),
    (
        "view",
        &[
            ("loft view roof.loft", "opens a page that follows the script"),
            ("loft view roof.loft --html roof.html", "one file with the model inside, for a colleague"),
        ],
    ),
    ("lsp", &[("loft lsp", "an editor starts it and talks to it over standard input and output")]),
    (
        "render",
        &[
            ("loft render roof.loft -o roof.png", "everything, seen from the corner"),
            ("loft render roof.loft -o top.svg --of vault --view top --shade zebra", "one surface from above with stripes"),
        ],
    ),
    (
        "test",
        &[
            ("loft test", "compares every model below here that has a golden"),
            ("loft test --accept roof.loft", "writes the golden of a model anew"),
            ("loft test --filter roof --junit report.xml", "some of them, for continuous integration"),
        ],
    ),
    ("diff", &[("loft diff old.loft new.loft", "what changed between two models"), ("loft diff a.golden b.golden", "or two goldens")]),
    ("new", &[("loft new hall", "a folder with a model and its golden test")]),
    ("fmt", &[("loft fmt roof.loft", "in place"), ("loft fmt --check .", "lists scripts that are not in canonical layout")]),
    (
        "explain",
        &[
            ("loft explain E501", "what a code means, with a broken script and how to fix it"),
            ("loft explain coons", "a word of the language, as `loft doc coons`"),
            ("loft explain roof.loft roof", "how a name of a model came about"),
        ],
    ),
    (
        "doc",
        &[
            ("loft doc", "all words in a line each"),
            ("loft doc mesh", "a declaration with its settings and members"),
            ("loft doc coons", "a function with its arguments"),
            ("loft doc E501", "a code, as `loft explain E501`"),
        ],
    ),
    (
        "completions",
        &[
            ("loft completions bash > ~/.local/share/bash-completion/completions/loft", "for bash"),
            ("loft completions fish > ~/.config/fish/completions/loft.fish", "for fish"),
        ],
    ),
    ("man", &[("loft man > loft.1", "the manual page")]),
];

/// The examples of a command.
pub fn of(command: &str) -> &'static [Example] {
    EXAMPLES.iter().find(|(name, _)| *name == command).map_or(&[], |(_, examples)| examples)
}

/// The examples as the end of a help text.
pub fn text(command: &str) -> String {
    let width = of(command).iter().map(|(line, _)| line.chars().count()).max().unwrap_or(0);
    let lines: Vec<String> = of(command).iter().map(|(line, what)| format!("  {line:width$}  {what}")).collect();
    format!("Examples:\n{}", lines.join("\n"))
}

#[cfg(test)]
mod tests {
    /// Every command has examples, and each is a command line that it takes.
    #[test]
    fn examples_are_taken() {
        for command in super::super::command_line().get_subcommands().filter(|c| !c.is_hide_set() || c.get_name() == "man") {
            let examples = super::of(command.get_name());
            assert!(!examples.is_empty(), "{} has no example", command.get_name());
            for (line, _) in examples {
                let words: Vec<&str> = line.split(['>', '<']).next().unwrap().split_whitespace().collect();
                assert_eq!(words[1], command.get_name(), "{line}");
                let matches = super::super::command_line().try_get_matches_from(&words);
                assert!(matches.is_ok(), "{line}: {}", matches.unwrap_err());
            }
        }
    }
}
