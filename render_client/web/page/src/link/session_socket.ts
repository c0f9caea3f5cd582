// The WebSocket to the gateway: opens the session with the token, or the ticket that replaced it, says what the page
// holds already, and opens it again after a loss, ever more slowly, until the gateway refuses for good.
import { create, fromBinary, toBinary, type MessageInitShape } from '@bufbuild/protobuf';
import { FromGuestSchema, ToGuestSchema, type Samples, type Welcome } from '#proto/gateway_pb';
import { trMark } from '../shared/language';

const kVersion = 2;
const kSubprotocol = 'bonemill.v1';
const kFirstWaitMs = 500, kLongestWaitMs = 15_000;
// The gateway is heard several times per second; a connection that is silent for so long is dead.
const kSilenceMs = 12_000;
const kMostFrameBytes = 8 << 20;

export interface SocketEvents {
  held(): { epoch: bigint; leaves: number[]; revisions: number[] };
  welcome(message: Welcome): void;
  samples(message: Samples): void;
  // After each frame: how many bytes have come on this connection.
  frame(bytes: number, connection: number): void;
  away(reason: string, sinceMs: number, nextTryMs: number): void;
  refused(reason: string): void;
}

export class SessionSocket {
  private socket?: WebSocket;
  private token = '';
  private url = '';
  private bytes = 0;
  private connection = 0;
  private wait = kFirstWaitMs;
  private awaySince = 0;  // 0: the session is open
  private retry?: ReturnType<typeof setTimeout>;
  private lastHeard = 0;
  private isOpen = false;
  private isRefused = false;

  constructor(private readonly events: SocketEvents) {
    setInterval(() => this.lookForSilence(), 2000);
  }

  get isWelcome(): boolean {
    return this.isOpen;
  }

  open(url: string, token: string): void {
    this.url = url;
    this.token = token;
    this.awaySince = Date.now();
    this.connect();
  }

  // The user, or a page that is seen again, does not want to wait.
  retryNow(): void {
    if (this.isOpen || this.isRefused || !this.url || this.socket?.readyState === WebSocket.CONNECTING) return;
    this.wait = kFirstWaitMs;
    this.connect();
  }

  send(kind: MessageInitShape<typeof FromGuestSchema>['kind']): void {
    if (this.socket?.readyState === WebSocket.OPEN)
      this.socket.send(toBinary(FromGuestSchema, create(FromGuestSchema, { kind })));
  }

  taken(bytes: number, connection: number): void {
    if (connection === this.connection) this.send({ case: 'received', value: { bytes: BigInt(bytes) } });
  }

  private connect(): void {
    clearTimeout(this.retry);
    this.drop();
    this.bytes = 0;
    const connection = ++this.connection;
    let socket: WebSocket;
    try {
      socket = new WebSocket(this.url, kSubprotocol);
    } catch {
      this.lost(trMark('The address of the session cannot be opened.'));
      return;
    }
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    this.lastHeard = Date.now();
    const ifCurrent = (act: () => void) => () => connection === this.connection && act();
    socket.onopen = ifCurrent(() => {
      this.send({ case: 'hello', value: { token: this.token, link: 'browser', version: kVersion, ...this.events.held() } });
    });
    socket.onmessage = (event) => {
      if (connection === this.connection) this.take(event.data);
    };
    socket.onclose = ifCurrent(() => this.lost(trMark('The connection is lost.')));
  }

  private drop(): void {
    const old = this.socket;
    this.socket = undefined;
    this.isOpen = false;
    if (!old) return;
    old.onopen = old.onmessage = old.onclose = null;
    old.close();
  }

  private lost(reason: string): void {
    this.drop();
    if (this.isRefused) return;
    this.awaySince ||= Date.now();
    const wait = this.wait * (0.75 + 0.5 * Math.random());  // a class does not come back all at once
    this.wait = Math.min(2 * this.wait, kLongestWaitMs);
    this.events.away(reason, this.awaySince, Date.now() + wait);
    this.retry = setTimeout(() => this.connect(), wait);
  }

  private lookForSilence(): void {
    if (this.socket && Date.now() - this.lastHeard > kSilenceMs) this.lost(trMark('The gateway is silent.'));
  }

  private take(data: unknown): void {
    this.lastHeard = Date.now();
    if (!(data instanceof ArrayBuffer) || data.byteLength > kMostFrameBytes) {
      this.lost(trMark('The gateway sent what is no frame.'));
      return;
    }
    this.bytes += data.byteLength;
    let kind;
    try {
      kind = fromBinary(ToGuestSchema, new Uint8Array(data)).kind;
    } catch {
      this.lost(trMark('The gateway sent what is no frame.'));
      return;
    }
    if (kind.case === 'welcome') this.enter(kind.value);
    else if (kind.case === 'refusal') this.refuse(kind.value.reason, kind.value.isFinal);
    else if (kind.case === 'samples' && this.isOpen) this.events.samples(kind.value);
    this.events.frame(this.bytes, this.connection);
  }

  private enter(welcome: Welcome): void {
    this.isOpen = true;
    this.wait = kFirstWaitMs;
    this.awaySince = 0;
    if (welcome.ticket) this.token = welcome.ticket;
    this.events.welcome(welcome);
  }

  private refuse(reason: string, is_final: boolean): void {
    if (!is_final) {
      this.lost(reason || trMark('The gateway does not let you in yet.'));
      return;
    }
    this.isRefused = true;
    this.drop();
    this.events.refused(reason);
  }
}
