//! `loft render MODEL -o PICTURE`.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use clap::{Arg, ArgAction, ArgMatches, value_parser};
use glam::DVec3;

use super::options::{self, Options};
use super::progress::with_progress;
use super::{Command, Exit, Terminal, interrupt, model};
use crate::base::limits::{PICTURE_LEAST, PICTURE_PIXELS, PICTURE_SIDE};
use crate::base::origin::Origin;
use crate::draw::{FORMATS, VIEWS, View};
use crate::lang::values::plans::{PICTURE_SIZE, PictureSpec, Show};
use crate::lang::values::settings::SHADES;
use crate::session::disk::Outputs;
use crate::session::guard::guarded;
use crate::session::run::{self, Task, Wanted};

/// Draws a model.
pub const COMMAND: Command = Command { name: "render", about: "Draw a model as PNG or SVG, without a window", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    let flag = |name: &'static str, help: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue).help(help);
    let text = |name: &'static str, value: &'static str, help: &'static str| Arg::new(name).long(name).value_name(value).help(help);
    let number = "a word or a direction from the model to the eye, `1,-2,0.5`";
    let views = VIEWS.iter().map(|v| v.0).collect::<Vec<_>>().join(", ");
    let command = command
        .arg(Arg::new("model").value_name("MODEL").required(true).help("A script, `-` for standard input"))
        .arg(
            Arg::new("out")
                .short('o')
                .long("out")
                .value_name("PICTURE")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("The file to write; its ending, png or svg, chooses the format"),
        )
        .arg(
            text("of", "THING", "What to draw: a name, `network`, `ribs[3]`, `roof.patches[0]` [default: everything]")
                .action(ArgAction::Append),
        )
        .arg(text("view", "VIEW", "").help(format!("{number} [default: isometric]\n[words: {views}]")).allow_hyphen_values(true))
        .arg(text("up", "X,Y,Z", "Direction that is up in the picture [default: z]").allow_hyphen_values(true))
        .arg(text("shade", "SHADE", "What colours show [default: plain]").value_parser(SHADES.to_vec()))
        .arg(text("zoom", "THING", "What fills the picture [default: everything drawn]").action(ArgAction::Append))
        .arg(text("size", "WxH", "Pixels across and down [default: 1200x800]"))
        .arg(text("title", "TEXT", "Words above the picture [default: the model's name]"))
        .arg(flag("perspective", "Near things are larger"))
        .arg(flag("network", "Draws the curves and nodes of the network with it"))
        .arg(flag("labels", "Names surfaces, curves, nodes and points"))
        .arg(flag("combs", "Draws curvature combs on curves"))
        .arg(flag("no-elements", "Leaves out the edges of elements"))
        .arg(flag("no-borders", "Leaves out the edges of faces"))
        .arg(flag("bare", "Leaves out axes, ruler and legend"));
    options::add_shared(command)
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let asked = Options::read_shared(matches).and_then(|options| Ok((wanted(matches)?, options)));
    let (wanted, options) = match asked {
        Ok(asked) => asked,
        Err(text) => return terminal.wrong_usage(&text),
    };
    let model = match model::open(&options.models[0], &options, Outputs::Written) {
        Ok(model) => model,
        Err(text) => return terminal.wrong_usage(&text),
    };
    let job = interrupt::job();
    let drawn = with_progress(&job, terminal.watched && !options.quiet, || draw(&model, &wanted, &options, &job));
    let outcome = match drawn {
        Ok(outcome) => outcome,
        Err(caught) => return model::bug(&caught, &model, terminal),
    };
    model::show(&outcome, &options, terminal);
    for row in &outcome.report.outputs {
        let place = options.out.as_deref().unwrap_or(Path::new("")).join(&row.path);
        terminal.print(&format!("{}  {} × {} pixels, {} bytes\n", place.display(), wanted.spec.size.0, wanted.spec.size.1, row.bytes));
    }
    model::exit_of(&outcome)
}

fn draw(
    model: &model::Model,
    wanted: &Wanted,
    options: &Options,
    job: &Arc<crate::base::job::Job>,
) -> Result<run::Outcome, crate::session::guard::Bug> {
    interrupt::protect(model.disk.staging());
    let started = Instant::now();
    let clock = move || started.elapsed().as_secs_f64();
    let task =
        Task { strict: options.strict, picture: Some(wanted), ..Task::new(model.name, model.text.as_bytes(), &options.sets, &clock) };
    guarded(|| run::run(&task, &model.disk, job))
}

/// What the command line asks for.
fn wanted(matches: &ArgMatches) -> Result<Wanted, String> {
    let word = |name: &str| matches.get_one::<String>(name).map(String::as_str);
    let many = |name: &str| matches.get_many::<String>(name).into_iter().flatten().cloned().collect::<Vec<String>>();
    let out = matches.get_one::<PathBuf>("out").ok_or("`-o PICTURE` is missing")?;
    let name = out.file_name().ok_or(format!("{} is not a file name", out.display()))?.to_string_lossy().into_owned();
    let ending = crate::io::extension(&name);
    if !FORMATS.iter().any(|(known, _)| *known == ending) {
        return Err(format!("`-o {}`: a picture ends in .png or .svg", out.display()));
    }
    let mut view = match word("view") {
        None => View::named("isometric").ok_or("no view")?,
        Some(text) => match View::named(text) {
            Some(view) => view,
            None => View { eye: direction(text).ok_or_else(|| unknown_view(text))?, up: None, perspective: false },
        },
    };
    if let Some(text) = word("up") {
        view.up = Some(direction(text).ok_or(format!("`--up {text}`: expected three numbers, for example 0,0,1"))?);
        if view.up_is_lost() {
            return Err(format!("`--up {text}` runs along the line of sight"));
        }
    }
    view.perspective = matches.get_flag("perspective");
    let on = |name: &str| matches.get_flag(name).then_some(true);
    let off = |name: &str| matches.get_flag(name).then_some(false);
    let spec = PictureSpec {
        things: Vec::new(),
        named: String::new(),
        path: name,
        path_origin: Origin::NONE,
        view,
        views: Vec::new(),
        size: word("size").map_or(Ok(PICTURE_SIZE), size)?,
        shade: word("shade").map(|w| (w.into(), Origin::NONE)),
        zoom: Vec::new(),
        title: word("title").map(Into::into),
        show: Show {
            elements: off("no-elements"),
            borders: off("no-borders"),
            network: on("network"),
            labels: on("labels"),
            axes: off("bare"),
            ruler: off("bare"),
            legend: off("bare"),
            combs: on("combs"),
        },
        origin: Origin::NONE,
    };
    Ok(Wanted { names: many("of"), zoom: many("zoom"), spec })
}

fn unknown_view(text: &str) -> String {
    let words = VIEWS.iter().map(|v| v.0).collect::<Vec<_>>().join(", ");
    format!("`--view {text}`: expected {words}, or three numbers as in 1,-2,0.5")
}

/// `1,-2,0.5`, with or without brackets; `None` for anything else and for no length.
fn direction(text: &str) -> Option<DVec3> {
    let inner = text.trim().trim_start_matches('(').trim_end_matches(')');
    let numbers: Vec<f64> = inner.split(',').map(|n| n.trim().parse().ok()).collect::<Option<_>>()?;
    let [x, y, z] = numbers.as_slice() else { return None };
    let direction = DVec3::new(*x, *y, *z);
    direction.try_normalize().map(|_| direction)
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let (least, most) = (PICTURE_LEAST, PICTURE_SIDE);
    let side = |n: &str| n.trim().parse::<u32>().ok().filter(|n| (least..=most).contains(n));
    let sides = text.split_once(['x', 'X', '×']).and_then(|(w, h)| Some((side(w)?, side(h)?)));
    let (width, height) =
        sides.ok_or(format!("`--size {text}`: expected WIDTHxHEIGHT, each {least} to {most} pixels, for example 1200x800"))?;
    if u64::from(width) * u64::from(height) > PICTURE_PIXELS {
        return Err(format!("`--size {text}`: a picture has at most {PICTURE_PIXELS} pixels"));
    }
    Ok((width, height))
}
