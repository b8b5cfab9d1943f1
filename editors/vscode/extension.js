// Starts `loft lsp` and leaves the rest to it.
const { commands, window, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

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

exports.activate = async (context) => {
  context.subscriptions.push(
    commands.registerCommand("loft.restart", restart),
    workspace.onDidChangeConfiguration((event) => event.affectsConfiguration("loft.path") && restart()),
  );
  await start();
};

exports.deactivate = stop;
