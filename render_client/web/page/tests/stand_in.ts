// A gateway for tests: serves the page with the gateway's headers, and a synthetic session over the same protocol, with
// TLS if it has a certificate. It lets in whoever has the token 'invited' or its ticket, and answers commands with "done".
import { create, fromBinary, toBinary } from '@bufbuild/protobuf';
import { createServer, type RequestListener } from 'node:http';
import { createServer as createTlsServer } from 'node:https';
import { readFileSync } from 'node:fs';
import { extname, join } from 'node:path';
import { WebSocketServer, type WebSocket } from 'ws';
import { FromGuestSchema, ToGuestSchema, type FromGuest, type Sample } from '#proto/gateway_pb';
import * as synthetic from './synthetic';

const kTypes: Record<string, string> = {
  '.html': 'text/html; charset=utf-8', '.css': 'text/css; charset=utf-8', '.js': 'text/javascript; charset=utf-8',
  '.json': 'application/json',
};
export const kPolicy = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self'; " +
  "connect-src 'self'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const kSender = 77n;

export interface Wish {
  page: string;
  role: number;
  nodes: Sample[];
  hasOthers: boolean;  // an instructor who points, and remarks
  tls?: { key: string; cert: string };
}

export interface StandIn {
  url: string;
  heard: FromGuest[];
  connections: number;
  show(samples: Sample[]): void;
  cut(): void;  // all connections
  close(): Promise<void>;
}

function toGuest(samples: Sample[]): Uint8Array {
  return toBinary(ToGuestSchema, create(ToGuestSchema, { kind: { case: 'samples', value: { samples, hasServer: true } } }));
}

export async function startStandIn({ page, role, nodes, hasOthers, tls }: Wish): Promise<StandIn> {
  const answer: RequestListener = (request, response) => {
    const asked = String(request.url).replace(/\?.*/, '').slice(1), name = asked || 'index.html';
    if (!/^(languages\/)?[a-z]+\.(html|css|js|json)$/.test(name)) return void response.writeHead(404).end();
    const headers = { 'Content-Type': kTypes[extname(name)], 'Content-Security-Policy': kPolicy, 'X-Content-Type-Options': 'nosniff' };
    response.writeHead(200, headers).end(readFileSync(join(page, name)));
  };
  const server = tls ? createTlsServer(tls, answer) : createServer(answer), sockets = new Set<WebSocket>();
  const sum = synthetic.sumOf(nodes);
  const stand_in: StandIn = {
    url: '', heard: [], connections: 0,
    show: (samples) => sockets.forEach((socket) => socket.send(toGuest(samples))),
    cut: () => sockets.forEach((socket) => socket.terminate()),
    close: async () => {
      clearInterval(beat);
      sockets.forEach((socket) => socket.terminate());
      await new Promise((done) => server.close(done));
    },
  };

  const welcome = (socket: WebSocket, hello: FromGuest['kind'] & { case: 'hello' }) => {
    const { token, leaves } = hello.value;
    if (token !== 'invited' && token !== 'ticket') {
      socket.send(toBinary(ToGuestSchema, create(ToGuestSchema, {
        kind: { case: 'refusal', value: { reason: 'This invitation is not known: ask for another one.', isFinal: true } },
      })));
      return socket.close();
    }
    socket.send(toBinary(ToGuestSchema, create(ToGuestSchema, {
      kind: { case: 'welcome', value: { ticket: 'ticket', name: 'Anna', role, sender: kSender, version: 2 } },
    })));
    sockets.add(socket);
    const held = new Set(leaves.map(BigInt)), wanted = nodes.filter((node) => !held.has(node.key));
    socket.send(toGuest([synthetic.sceneInfo(), synthetic.status({ nodes: sum }), synthetic.toolState(0), synthetic.lesson(), synthetic.nerve()]));
    for (let i = 0; i < wanted.length; i += 48) socket.send(toGuest(wanted.slice(i, i + 48)));
    if (hasOthers) socket.send(toGuest([synthetic.viewer(5, 'Dr. Weber', 2, [0.003, -0.0085, 0.005]), synthetic.remark(0, 'Thin <i id="bad">here</i>', [-0.004, -0.0085, 0.004]), synthetic.remark(1, '', synthetic.arc())]));
  };

  const sessions = new WebSocketServer({ server, path: '/session', handleProtocols: (all) => (all.has('bonemill.v1') ? 'bonemill.v1' : false) });
  sessions.on('connection', (socket) => {
    ++stand_in.connections;
    socket.on('close', () => sockets.delete(socket));
    socket.on('message', (data: Buffer) => {
      const message = fromBinary(FromGuestSchema, data);
      stand_in.heard.push(message);
      if (message.kind.case === 'hello') welcome(socket, message.kind);
      if (message.kind.case !== 'command') return;
      const { sequence, action } = message.kind.value;
      stand_in.show([synthetic.status({
        nodes: sum, isPaused: action.case === 'pauseMilling' && action.value, answer: { sender: kSender, sequence, result: 'done' },
      })]);
    });
  });
  let beats = 0;
  const beat = setInterval(() => {
    if (++beats % 20 !== 0) return;
    stand_in.show(hasOthers ? [synthetic.viewer(5, 'Dr. Weber', 2, [0.003, -0.0085, 0.005])] : [synthetic.status({ nodes: sum })]);
  }, 50);
  await new Promise<void>((done) => server.listen(0, '127.0.0.1', done));
  stand_in.url = `${tls ? 'https' : 'http'}://127.0.0.1:${(server.address() as { port: number }).port}/`;
  return stand_in;
}
