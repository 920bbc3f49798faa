// SPDX-License-Identifier: BSD-3-Clause
// The language server that VS Code's YAML extension runs, spoken to as an editor does.
import {spawn} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';

const server = join(dirname(fileURLToPath(import.meta.url)),
                    'node_modules/yaml-language-server/bin/yaml-language-server');

export class LanguageServer {
  #process = spawn(process.execPath, [server, '--stdio'], {stdio: ['pipe', 'pipe', 'inherit']});
  #received = Buffer.alloc(0);
  #replies = new Map();      // id -> resolve
  #diagnostics = new Map();  // uri -> resolve
  #settings;
  #next = 1;
  #version = 0;  // of all texts: it remembers what it read by it

  // settings: of the section `yaml`, as in an editor's settings.json.
  constructor(settings = {}) {
    this.#settings = settings;
    this.#process.stdout.on('data', (data) => this.#take(data));
  }

  async start() {
    await this.#request('initialize', {
      processId: process.pid, rootUri: null,
      capabilities: {
        workspace: {configuration: true},
        textDocument: {publishDiagnostics: {}, completion: {completionItem: {}}, hover: {contentFormat: ['markdown']}},
      },
    });
    this.#send({method: 'initialized', params: {}});
    this.#send({method: 'workspace/didChangeConfiguration', params: {settings: this.#all()}});
  }

  // What the editor would mark: [{line, message}], lines from 1. `text` may differ from the file's.
  async marks(file, text = readFileSync(file, 'utf8')) {
    const uri = pathToFileURL(file).href;
    const marks = await this.#told(uri, 'textDocument/didOpen',
                                   {uri, languageId: 'yaml', version: ++this.#version, text});
    await this.#told(uri, 'textDocument/didClose', {uri});  // it says that nothing is marked
    return marks.map(({range, message}) => ({line: range.start.line + 1, message}));
  }

  // What it offers at a place of a file with this text, lines and columns from 1: labels, in its order.
  async offers(file, text, line, column) {
    const answer = await this.#ask('textDocument/completion', file, text, line, column);
    return answer.items.map(({label}) => label);
  }

  // What it says of the word there.
  async says(file, text, line, column) {
    return (await this.#ask('textDocument/hover', file, text, line, column)).contents.value;
  }

  stop() { this.#process.kill(); }

  async #ask(method, file, text, line, column) {
    const uri = pathToFileURL(file).href;
    this.#send({method: 'textDocument/didOpen',
                params: {textDocument: {uri, languageId: 'yaml', version: ++this.#version, text}}});
    const position = {line: line - 1, character: column - 1};
    const answer = await this.#request(method, {textDocument: {uri}, position});
    await this.#told(uri, 'textDocument/didClose', {uri});
    return answer;
  }

  #all() {
    return {yaml: {validate: true, completion: true, hover: true, schemaStore: {enable: false}, ...this.#settings},
            http: {}, '[yaml]': {}, editor: {}, files: {}};
  }

  #told(uri, method, textDocument) {
    this.#send({method, params: {textDocument}});
    return new Promise((resolve) => this.#diagnostics.set(uri, resolve));
  }

  #request(method, params) {
    const id = this.#next++;
    this.#send({id, method, params});
    return new Promise((resolve) => this.#replies.set(id, resolve));
  }

  #send(message) {
    const body = Buffer.from(JSON.stringify({jsonrpc: '2.0', ...message}));
    this.#process.stdin.write(`Content-Length: ${body.length}\r\n\r\n`);
    this.#process.stdin.write(body);
  }

  #take(data) {
    this.#received = Buffer.concat([this.#received, data]);
    for (;;) {
      const head = this.#received.indexOf('\r\n\r\n');
      if (head < 0) return;
      const length = Number(/Content-Length: (\d+)/.exec(this.#received.toString('ascii', 0, head))[1]);
      if (this.#received.length < head + 4 + length) return;
      const message = JSON.parse(this.#received.toString('utf8', head + 4, head + 4 + length));
      this.#received = this.#received.subarray(head + 4 + length);
      this.#handle(message);
    }
  }

  #handle({id, method, params, result, error}) {
    if (method === undefined) {
      if (error) throw new Error(error.message);
      this.#replies.get(id)?.(result);
      this.#replies.delete(id);
    } else if (method === 'textDocument/publishDiagnostics') {
      this.#diagnostics.get(params.uri)?.(params.diagnostics);
      this.#diagnostics.delete(params.uri);
    } else if (method === 'workspace/configuration') {
      this.#send({id, result: params.items.map(({section}) => this.#all()[section] ?? null)});
    } else if (id !== undefined) {
      this.#send({id, result: null});
    }
  }
}
