//! What a session shows of names: values, dependencies, meshes, and whether they may be removed.

use super::edit::shown_table;
use super::{Answer, Notebook, Part, ended};
use crate::lang::run::symbols::{Condition, Symbol, about_mesh};
use crate::lang::values::value::Value;
use crate::session::live::Depth;
use crate::session::view::write_back::defaults_of;

impl Notebook {
    fn symbol(&self, name: &str) -> Result<usize, Answer> {
        // A member of a family stands in the family's declaration.
        let base = name.split('[').next().unwrap_or(name).trim();
        match self.now.symbols.iter().position(|s| s.name.as_deref() == Some(base)) {
            Some(found) => Ok(found),
            None => {
                let names = self.now.symbols.iter().filter_map(|s| s.name.as_deref());
                let near = crate::lang::words::names::nearest(name, names);
                let hint = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
                Err(Answer::failure(format!("`{name}` is not defined{hint}")))
            }
        }
    }

    /// The name of a declaration, or the first line of its text.
    fn title(&self, symbol: &Symbol) -> String {
        let text = self.now.state.text.get(symbol.span.start as usize..symbol.span.end as usize).unwrap_or("");
        symbol.name.clone().unwrap_or_else(|| text.lines().next().unwrap_or("").to_owned())
    }

    pub(super) fn show(&mut self, name: &str) -> Answer {
        let symbol = match self.symbol(name) {
            Ok(found) => self.now.symbols[found].clone(),
            Err(answer) => return answer,
        };
        let text = self.now.state.text.get(symbol.span.start as usize..symbol.span.end as usize).unwrap_or("").to_owned();
        if symbol.condition != Condition::Sound {
            return Answer::failure(format!("{text}\n{name} has no value: {}", self.reason(&symbol)));
        }
        let (mut line, mut table) = (None, None);
        let state = self.now.state.clone();
        let result = self.run(&state, Depth::Values, &mut |cx| {
            line = cx.describe_name(name);
            table = cx.value_of(name).and_then(|value| cx.table_of(&value)).map(|t| shown_table(cx, &t));
        });
        if let Err(answer) = result {
            return answer;
        }
        let mut answer = Answer::default();
        answer.parts.extend(symbol.doc.map(Part::Text));
        answer.say(text);
        answer.parts.extend(line.map(Part::Text));
        answer.parts.extend(table.map(Part::Table));
        answer
    }

    /// Why a declaration has no value: it was reported, or something below it was.
    fn reason(&self, symbol: &Symbol) -> String {
        match symbol.needs.iter().map(|n| &self.now.symbols[*n]).find(|s| s.condition != Condition::Sound) {
            Some(below) => format!("it needs `{}`, which has none either", self.title(below)),
            None => "see the report about it".to_owned(),
        }
    }

    pub(super) fn why(&mut self, name: &str) -> Answer {
        if name.contains('[') {
            let member = self.ask(name);
            if member.failed {
                return member;
            }
        }
        let found = match self.symbol(name) {
            Ok(found) => found,
            Err(answer) => return answer,
        };
        let mut out = String::new();
        let mut tree = |title: &str, next: &dyn Fn(usize) -> Vec<usize>| {
            let mut seen = vec![found];
            let mut stack: Vec<(usize, usize)> = next(found).into_iter().rev().map(|n| (n, 1)).collect();
            out.push_str(title);
            if stack.is_empty() {
                out.push_str(" nothing");
            }
            out.push('\n');
            while let Some((at, depth)) = stack.pop() {
                let again = seen.contains(&at);
                let more = if again && !next(at).is_empty() { " …" } else { "" };
                out.push_str(&format!("{}{}{more}\n", "  ".repeat(depth), self.title(&self.now.symbols[at])));
                if !again {
                    seen.push(at);
                    stack.extend(next(at).into_iter().rev().map(|n| (n, depth + 1)));
                }
            }
        };
        tree(&format!("{name} depends on"), &|at| self.now.symbols[at].needs.clone());
        let users = self.users();
        tree(&format!("what depends on {name}:"), &|at| users[at].clone());
        let mut answer = Answer::text(out.trim_end());
        if self.now.symbols[found].condition != Condition::Sound {
            answer.say(format!("{name} has no value: {}", self.reason(&self.now.symbols[found])));
        }
        answer
    }

    /// For each declaration those that name it.
    fn users(&self) -> Vec<Vec<usize>> {
        let mut users = vec![Vec::new(); self.now.symbols.len()];
        for (n, symbol) in self.now.symbols.iter().enumerate() {
            symbol.needs.iter().filter(|need| **need != n).for_each(|need| users[*need].push(n));
        }
        users
    }

    /// Takes a declaration out, with all that stands on it when `all`; else only when nothing does.
    pub(super) fn remove(&mut self, name: &str, all: bool) -> Answer {
        let found = match self.symbol(name) {
            Ok(found) => found,
            Err(answer) => return answer,
        };
        let users = self.users();
        let (mut gone, mut met) = (vec![found], vec![false; users.len()]);
        met[found] = true;
        let mut next = 0;
        while next < gone.len() {
            for &user in &users[gone[next]] {
                if !std::mem::replace(&mut met[user], true) {
                    gone.push(user);
                }
            }
            next += 1;
        }
        if gone.len() > 1 && !all {
            let first: Vec<String> = users[found].iter().map(|u| format!("`{}`", self.title(&self.now.symbols[*u]))).collect();
            let mut order: Vec<String> = gone[1..].iter().rev().map(|g| self.title(&self.now.symbols[*g])).collect();
            order.truncate(12);
            return Answer::failure(format!(
                "E510 × `{name}` is used by {}\n  help: remove {} first, or `:remove! {name}` to remove all {}",
                first.join(", "),
                order.join(", "),
                gone.len()
            ));
        }
        let mut texts: Vec<(u32, u32)> = gone.iter().map(|g| (self.now.symbols[*g].span.start, self.now.symbols[*g].span.end)).collect();
        texts.sort_unstable();
        let titles: Vec<String> = gone.iter().map(|g| self.title(&self.now.symbols[*g])).collect();
        let names: Vec<String> = gone.iter().filter_map(|g| self.now.symbols[*g].name.clone()).collect();
        let state = self.without(&names, &texts);
        let mut answer = Answer::text(format!("removed {}", titles.join(", ")));
        for name in &names {
            self.now.conditions.remove(name);
        }
        let changed = self.change(state, &[]);
        answer.failed = changed.failed;
        answer.parts.extend(changed.parts);
        answer
    }

    pub(super) fn mesh(&mut self, name: &str) -> Answer {
        if let Err(answer) = self.symbol(name) {
            return answer;
        }
        let mut found = Vec::new();
        let mut wrong = false;
        let state = self.now.state.clone();
        let result = self.run(&state, Depth::Values, &mut |cx| {
            let mut values = Vec::new();
            match cx.value_of(name) {
                Some(Value::List(items)) => values.extend(items.iter().cloned()),
                Some(value) => values.push(value),
                None => {}
            }
            for value in values {
                let Value::Mesh(mesh) = &value else {
                    wrong = true;
                    continue;
                };
                let shown = cx.show(&value);
                if let Ok(mesh) = cx.mesh(mesh) {
                    let groups: Vec<String> =
                        mesh.groups.iter().map(|g| format!("{} {}", g.name, g.lines.len() + g.triangles.len() + g.quads.len())).collect();
                    found.push(format!("mesh {shown}: {}", about_mesh(&mesh)));
                    if !groups.is_empty() {
                        found.push(format!("  elements of {}", groups.join(", ")));
                    }
                }
            }
        });
        let outcome = match result {
            Ok(outcome) => outcome,
            Err(answer) => return answer,
        };
        if wrong {
            return Answer::failure(format!("`{name}` is not a mesh"));
        }
        let mut answer = Answer { failed: found.is_empty(), ..Answer::default() };
        let before = std::mem::take(&mut self.now.said);
        self.now.said.extend(before.iter().filter(|s| !s.0.starts_with("E7")).cloned());
        self.tell_new(&outcome, &mut answer);
        self.now.said = before;
        found.into_iter().for_each(|line| answer.say(line));
        answer
    }

    /// The script with the params that were set as their defaults.
    pub fn saved_text(&self) -> String {
        let mut text = ended(&self.now.state.text);
        for (name, value) in &self.now.state.sets {
            if let Some(span) = defaults_of(&text, name).first() {
                text.replace_range(span.start as usize..span.end as usize, value);
            }
        }
        text
    }
}
