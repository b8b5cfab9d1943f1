//! The server: its threads, what they share, and how they end.

use std::net::{TcpListener, TcpStream};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant, SystemTime};

use serde_json::{Value, json};

use super::compress::Packed;
use super::connections::Connections;
use super::events::{Events, Kind};
use super::frames::Frames;
use super::gate::Gate;
use super::http::Connection;
use super::listen::{StartError, listen};
use super::model::{Frame, Model, Script};
use super::routes;
use super::watch::Watch;
use super::work::Work;

/// Time between two rounds of what is to be done some times a second; pages are told of progress in every one.
const ROUND: Duration = Duration::from_millis(100);

/// How long the thread of the model may take to end; then it is left behind.
const PATIENCE: Duration = Duration::from_millis(500);

/// Bytes of a connection's thread for its calls.
const STACK: usize = 512 * 1024;

/// What is served, and where.
pub struct Settings {
    /// The script to watch.
    pub script: PathBuf,
    /// The port asked for, 0 for any that is free; `None` takes the default one or the next that is free.
    pub port: Option<u16>,
    /// The page: HTML with scripts and styles inside.
    pub page: Arc<Vec<u8>>,
    /// Params that are set from the beginning, by name.
    pub sets: Vec<(String, String)>,
}

/// What the threads of a server share.
pub struct Shared {
    /// Who may ask.
    pub gate: Gate,
    /// The page.
    pub page: Packed,
    /// What the page shows.
    pub frames: Frames,
    /// What the open pages are told.
    pub events: Events,
    /// What is evaluated.
    pub work: Work,
    /// The script behind the model.
    pub script: Arc<dyn Script>,
    /// Who is being served.
    pub connections: Arc<Connections>,
    watch: Mutex<Watch>,
    /// The name of the script, as pages see it.
    name: String,
    over: AtomicBool,
}

/// A server that is running; it ends when this is dropped.
pub struct Server {
    shared: Arc<Shared>,
    port: u16,
    threads: Vec<JoinHandle<()>>,
}

impl Server {
    /// Starts to serve, watch and evaluate.
    ///
    /// Fails when no port can be had, and when the system has no random numbers or no threads to give.
    pub fn start(settings: Settings, model: Box<dyn Model>, script: Arc<dyn Script>) -> Result<Self, StartError> {
        let listener = listen(settings.port)?;
        let port = listener.local_addr().map_err(|error| StartError::Port(settings.port.unwrap_or(0), error))?.port();
        let shared = Arc::new(Shared {
            gate: Gate::new(port).map_err(|error| StartError::Random(error.to_string()))?,
            page: Packed::new(settings.page),
            frames: Frames::default(),
            events: Events::default(),
            work: Work::new(settings.sets),
            script,
            connections: Arc::default(),
            watch: Mutex::new(Watch::new(&settings.script)),
            name: settings.script.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            over: AtomicBool::new(false),
        });
        let mut server = Self { shared, port, threads: Vec::new() };
        server.spawn("view watch", watch)?;
        server.spawn("view rounds", rounds)?;
        server.spawn("view accept", move |shared| accept(shared, &listener))?;
        server.spawn("view model", move |shared| evaluate(shared, model))?;
        Ok(server)
    }

    /// The address of the page, with its token.
    pub fn address(&self) -> String {
        self.shared.gate.address()
    }

    /// An address for the arguments of a browser, which others on the machine can read: it leads to the page once.
    ///
    /// Fails when the system has no random numbers.
    pub fn address_for_once(&self) -> Result<String, StartError> {
        self.shared.gate.address_for_once().map_err(|error| StartError::Random(error.to_string()))
    }

    /// The port that it listens at.
    pub fn port(&self) -> u16 {
        self.port
    }

    /// What its threads share, for whoever wants to tell the pages something or to know what they show.
    pub fn shared(&self) -> &Arc<Shared> {
        &self.shared
    }

    /// Serves until `is_over` says so, which is asked some times a second; then ends within a second.
    pub fn run(self, mut is_over: impl FnMut() -> bool) {
        while !is_over() {
            thread::sleep(Duration::from_millis(50));
        }
    }

    fn spawn(&mut self, name: &str, work: impl FnOnce(&Arc<Shared>) + Send + 'static) -> Result<(), StartError> {
        let shared = self.shared.clone();
        let thread = thread::Builder::new().name(name.to_owned()).spawn(move || work(&shared)).map_err(StartError::Thread)?;
        self.threads.push(thread);
        Ok(())
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.shared.over.store(true, Ordering::Relaxed);
        self.shared.work.end();
        self.shared.connections.end();
        self.shared.events.end();
        // Wakes the thread that waits for connections.
        let _ = TcpStream::connect_timeout(&(std::net::Ipv4Addr::LOCALHOST, self.port).into(), PATIENCE);
        let deadline = Instant::now() + PATIENCE;
        for thread in self.threads.drain(..) {
            while !thread.is_finished() && Instant::now() < deadline {
                thread::sleep(Duration::from_millis(2));
            }
            if thread.is_finished() {
                // A panic in it has nobody left to tell.
                let _ = thread.join();
            }
        }
    }
}

impl Shared {
    fn is_over(&self) -> bool {
        self.over.load(Ordering::Relaxed)
    }

    /// Keeps a frame and tells the pages, unless there is a newer one.
    fn show(&self, number: u64, frame: Frame) {
        if self.frames.publish(number, frame) {
            let (newest, json) = self.frames.newest_if_small();
            self.events.frame(newest, json);
        }
    }
}

/// Takes connections; each has a thread of its own, and their number is bounded.
fn accept(shared: &Arc<Shared>, listener: &TcpListener) {
    while !shared.is_over() {
        let Ok((stream, _)) = listener.accept() else {
            // Out of files, most likely; some connection will end.
            thread::sleep(Duration::from_millis(20));
            continue;
        };
        let stream = Arc::new(stream);
        let Some(place) = shared.connections.admit(&stream) else { continue };
        let shared = shared.clone();
        let serve = move || {
            let mut connection = Connection::new(stream, place).ok();
            while let Some(open) = connection.take().filter(|_| !shared.is_over()) {
                connection = routes::answer(&shared, open);
            }
        };
        // Where no thread can be had, the connection ends.
        let _ = thread::Builder::new().name("view connection".to_owned()).stack_size(STACK).spawn(serve);
    }
}

fn watch(shared: &Arc<Shared>) {
    while !shared.is_over() {
        let news = shared.watch.lock().unwrap_or_else(PoisonError::into_inner).look();
        if news.gone {
            shared.work.gone();
            end_partial(shared);
            shared.events.tell(Kind::Gone, &json!({ "file": shared.name }));
        }
        match news.text {
            Some(text) => {
                shared.events.returned();
                shared.work.saved(text);
            }
            None if news.files => shared.work.file_saved(),
            None => {}
        }
        thread::sleep(news.rest);
    }
}

fn rounds(shared: &Arc<Shared>) {
    while !shared.is_over() {
        shared.work.tick();
        shared.work.progress(|data| shared.events.tell(Kind::Work, data));
        shared.events.tick();
        thread::sleep(ROUND);
    }
}

fn evaluate(shared: &Arc<Shared>, mut model: Box<dyn Model>) {
    while let Some((request, running)) = shared.work.next() {
        let started = SystemTime::now();
        let (to, number) = (shared.clone(), running.number - 1);
        running.evaluation.show_partial_by(Box::new(move |frame| {
            to.show(number, frame);
        }));
        // What a panic leaves behind is the model's business: the next evaluation finds it.
        let evaluated = catch_unwind(AssertUnwindSafe(|| model.evaluate(&request, &running.evaluation)));
        let more = evaluated.as_ref().is_ok_and(|evaluated| evaluated.more);
        let frame = match evaluated {
            Ok(evaluated) => {
                if let Some(files) = evaluated.files {
                    shared.watch.lock().unwrap_or_else(PoisonError::into_inner).set_files(&files, started);
                }
                evaluated.frame
            }
            Err(_) => Some(message_frame(shared, running.number, ("error", "bug"), BUG)),
        };
        if let Some(frame) = frame {
            shared.show(running.number, frame);
        }
        if more && !running.evaluation.is_stopped() {
            shared.work.again();
        }
        if !shared.work.is_due() {
            end_partial(shared);
        }
        shared.work.finished(|data| shared.events.tell(Kind::Work, data));
    }
}

/// A partial frame must not be the last one: where no evaluation follows it, a whole one does.
fn end_partial(shared: &Shared) {
    if shared.frames.is_partial() {
        let number = shared.frames.number() + 1;
        shared.show(number, message_frame(shared, number, ("note", "stopped"), STOPPED));
    }
}

/// Message of an evaluation that ended in a bug.
const BUG: &str = "a bug in loft stopped this evaluation; please report it with this script";
/// Message of an evaluation that was stopped when its shapes were shown.
const STOPPED: &str = "the evaluation was stopped; the next change of the script starts it again";

/// What the page showed before, with one message: its severity and code, and its text.
fn message_frame(shared: &Shared, number: u64, (severity, code): (&str, &str), message: &str) -> Frame {
    let (before, buffers) = shared.frames.newest_frame().unwrap_or_default();
    let mut frame: Value = serde_json::from_slice(&before).unwrap_or_else(|_| empty_frame(&shared.name));
    frame["number"] = number.into();
    frame["ok"] = false.into();
    frame["stale"] = true.into();
    let whole: Option<Value> = shared.frames.newest_whole().and_then(|whole| serde_json::from_slice(whole.plain()).ok());
    if let (true, Some(whole)) = (frame["partial"] == true, whole) {
        // A partial frame has no checks and no tables; what it leaves out is that of the whole one before.
        for list in ["checks", "reports", "pictures", "outputs"] {
            frame[list] = whole[list].clone();
        }
    }
    frame["partial"] = false.into();
    if frame["compare"]["pending"] == true {
        frame["compare"]["pending"] = false.into();
        frame["compare"]["failed"] = message.into();
    }
    frame["diagnostics"] = json!([{ "severity": severity, "code": code, "message": message, "help": null, "places": [], "points": [],
        "size": null, "things": [] }]);
    Frame { json: frame.to_string(), buffers }
}

/// A frame in which nothing is drawn.
fn empty_frame(name: &str) -> Value {
    json!({ "loft": 1, "number": 0, "model": name, "title": name, "units": "", "ok": false, "stale": true, "drawn": 0, "seconds": 0.0,
        "box": null, "chord_error": 0.0, "things": [], "sources": [], "params": [], "diagnostics": [], "checks": [], "reports": [],
        "pictures": [], "outputs": [], "compare": null })
}
