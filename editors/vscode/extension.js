// Starts `loft lsp` and leaves the rest to it; `loft view` shows a script beside its text.
const { spawn } = require("node:child_process");
const path = require("node:path");
const { createInterface } = require("node:readline");
const { Uri, commands, window, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;
// Pages by script: the program that serves one, and its address.
const pages = new Map();
const servers = new Set();

async function start() {
  const command = workspace.getConfiguration("loft").get("path", "loft");
  client = new LanguageClient("loft", "Loft", { command, args: ["lsp"] }, { documentSelector: [{ language: "loft" }] });
  try {
    await client.start();
  } catch (error) {
    client = undefined;
    window.showErrorMessage(`"${command} lsp" does not start (${error.message}). Install loft, or set "loft.path".`);
  }
}

async function stop() {
  const old = client;
  client = undefined;
  await old?.stop();
}

async function restart() {
  await stop();
  await start();
}

async function view() {
  const document = window.activeTextEditor?.document;
  if (document?.languageId !== "loft" || document.isUntitled) {
    window.showInformationMessage("Open a saved .loft script to show its model.");
    return;
  }
  await document.save();
  const file = document.fileName;
  if (!pages.has(file)) pages.set(file, serve(file));
  try {
    // The page stands beside the text and follows every save.
    await commands.executeCommand("simpleBrowser.api.open", await pages.get(file), { viewColumn: -2, preserveFocus: true });
  } catch (error) {
    pages.delete(file);
    window.showErrorMessage(`The model cannot be shown: ${error.message}`);
  }
}

// Starts `loft view` and gives the address that it prints.
function serve(file) {
  const command = workspace.getConfiguration("loft").get("path", "loft");
  const server = spawn(command, ["view", path.basename(file), "--no-open", "--port", "0"], { cwd: path.dirname(file) });
  servers.add(server);
  let said = "";
  server.stderr.on("data", (data) => (said += data));
  return new Promise((done, failed) => {
    server.on("error", failed);
    server.on("exit", () => {
      servers.delete(server);
      pages.delete(file);
      failed(new Error(said.trim() || "`loft view` ended"));
    });
    createInterface({ input: server.stdout }).once("line", (line) => done(Uri.parse(line.trim())));
  });
}

exports.activate = async (context) => {
  context.subscriptions.push(
    commands.registerCommand("loft.restart", restart),
    commands.registerCommand("loft.view", view),
    workspace.onDidChangeConfiguration((event) => event.affectsConfiguration("loft.path") && restart()),
  );
  await start();
};

exports.deactivate = async () => {
  servers.forEach((server) => server.kill());
  await stop();
};
