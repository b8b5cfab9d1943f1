//! The guide holds when it is followed letter by letter: its commands print what stands there, and it tells of every setting and format.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use lofting::lang::diag::codes::CODES;
use lofting::lang::eval::std::builtins;
use lofting::lang::values::settings::{BLOCKS, EXPORT, IMPORT};

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("loft-guide-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn with_examples(self) -> Self {
        for (from, to) in [("examples", self.0.clone()), ("examples/data", self.0.join("data"))] {
            fs::create_dir_all(&to).unwrap();
            for file in fs::read_dir(from).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file()) {
                fs::copy(&file, to.join(file.file_name().unwrap())).unwrap();
            }
        }
        self
    }

    /// Standard output, and with standard error behind it.
    fn loft(&self, line: &str) -> [String; 2] {
        let words: Vec<&str> = line.split_whitespace().collect();
        assert_eq!(words[0], "loft", "{line}");
        let done = Command::new(env!("CARGO_BIN_EXE_loft")).args(&words[1..]).current_dir(&self.0).output().unwrap();
        let [out, err] = [done.stdout, done.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        [out.clone(), out + &err]
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// What `loft` prints with these arguments.
fn printed(arguments: &[&str]) -> String {
    let done = Command::new(env!("CARGO_BIN_EXE_loft")).args(arguments).output().unwrap();
    String::from_utf8(done.stdout).unwrap() + &String::from_utf8(done.stderr).unwrap()
}

/// The page with what its commands print now. A block of a script goes to the file that the text names last before it.
fn followed(page: &str, folder: &Folder) -> String {
    let mut out = String::new();
    let mut file = None;
    let mut rest = page;
    while let Some(start) = rest.find("```") {
        let (before, block) = rest.split_at(start);
        let names = before.split('`').skip(1).step_by(2);
        file = names.filter(|name| name.ends_with(".loft") && !name.contains(' ')).last().or(file);
        let (word, body) = block[3..].split_once('\n').unwrap();
        let end = body.find("```").unwrap();
        let (body, after) = (&body[..end], &body[end + 3..]);
        out.push_str(&format!("{before}```{word}\n"));
        match (word, file) {
            ("console", _) => out.push_str(&console(body, folder)),
            ("loft", Some(file)) => {
                fs::write(folder.0.join(file), body).unwrap();
                out.push_str(body);
            }
            _ => out.push_str(body),
        }
        out.push_str("```");
        rest = after;
    }
    out + rest
}

/// Commands with what they print: standard output alone where that is what stands there.
fn console(body: &str, folder: &Folder) -> String {
    let mut out = String::new();
    for part in body.split("$ ").filter(|part| !part.is_empty()) {
        let (line, stands) = part.split_once('\n').unwrap();
        let [alone, both] = folder.loft(line);
        out.push_str(&format!("$ {line}\n{}", if stands == alone { alone } else { both }));
    }
    out
}

/// `LOFT_GUIDE=write` writes the pages as their commands print now.
#[test]
fn commands_of_the_guide_print_what_stands_there() {
    let mut seen = 0;
    let mut pages: Vec<PathBuf> = fs::read_dir("docs/guide").unwrap().map(|entry| entry.unwrap().path()).collect();
    pages.sort();
    for path in pages.iter().filter(|path| path.extension().is_some_and(|ending| ending == "md")) {
        let page = fs::read_to_string(path).unwrap();
        if !page.contains("```console\n") {
            continue;
        }
        seen += page.matches("\n$ loft ").count();
        let folder = Folder::new(&path.file_stem().unwrap().to_string_lossy()).with_examples();
        let now = followed(&page, &folder);
        if std::env::var("LOFT_GUIDE").is_ok_and(|word| word == "write") {
            fs::write(path, &now).unwrap();
        } else if let Some((stands, prints)) = page.lines().zip(now.lines()).find(|(a, b)| a != b) {
            panic!("{}:\n  stands there: {stands}\n  is printed:   {prints}", path.display());
        } else {
            assert_eq!(page, now, "{}", path.display());
        }
    }
    assert!(seen >= 6, "{seen} commands");
}

#[test]
fn the_manual_page_is_current() {
    let kept = fs::read_to_string(Path::new("docs/man/loft.1")).unwrap();
    assert!(printed(&["man"]) == kept, "docs/man/loft.1 is not current: loft man > docs/man/loft.1");
}

/// `loft doc WORD` tells all settings of the block that the word opens.
#[test]
fn settings_are_told_by_the_word_that_opens_their_block() {
    for (form, table) in BLOCKS {
        let word = form.split(' ').next().unwrap();
        let told = printed(&["doc", word]);
        assert!(!table.is_empty() && told.contains(&format!("settings of `{form}`")), "{word}: {told}");
        for setting in *table {
            assert!(told.contains(&format!("\n    {}: ", setting.key)), "{word} does not tell `{}`", setting.key);
            assert!(printed(&["doc", setting.key]).contains(setting.docs), "{}", setting.key);
        }
    }
    assert!(printed(&["doc", "group"]).contains("It takes no settings."));
    for member in ["min_angle", "chord_error", "watertight"] {
        assert!(printed(&["doc", "mesh"]).contains(&format!("\n    {member} ")), "{member}");
    }
}

/// `doc` knows codes and `explain` knows words: either may be asked.
#[test]
fn doc_and_explain_answer_for_each_other() {
    for code in [CODES[0].code, "e501", "W701"] {
        assert_eq!(printed(&["doc", code]), printed(&["explain", code]));
        assert!(printed(&["doc", code]).starts_with(&format!("# {}: ", code.to_uppercase())));
    }
    for word in ["coons", "mesh", "size", "length", builtins().last().unwrap().name] {
        assert_eq!(printed(&["explain", word]), printed(&["doc", word]));
        assert!(!printed(&["doc", word]).contains("no word of the language"), "{word}");
    }
    assert_eq!(printed(&["doc", "W501"]), "loft: there is no code W501; did you mean E501?\n");
    assert_eq!(printed(&["explain", "conos"]), "loft: no word of the language is called `conos`; did you mean cones or combs or conic?\n");
}

#[test]
fn the_chapter_on_files_tells_every_setting_and_format() {
    let page = fs::read_to_string("docs/guide/files.md").unwrap();
    let (written, read) = page.split_once("## Read").unwrap();
    for (part, table) in [(written, EXPORT), (read, IMPORT)] {
        for setting in table {
            assert!(part.contains(&format!("| `{}` |", setting.key)), "{}", setting.key);
        }
    }
    let endings = lofting::io::FORMATS.iter().flat_map(|format| format.extensions.iter());
    for ending in endings.chain(&["csv", "svg", "igs", "iges", "json", "png"]) {
        assert!(written.contains(&format!("`.{ending}`")), "{ending}");
    }
    assert!(page.contains("(../report.schema.json)"));
    for page in ["syntax.md", "files.md"] {
        assert!(fs::read_to_string("docs/guide/README.md").unwrap().contains(page), "{page}");
    }
}
