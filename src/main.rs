//! The `loft` program; everything it does lives in [`lofting::cli`].

fn main() -> std::process::ExitCode {
    lofting::cli::main()
}
