// What the page knows of the session: the newest of everything that came, and who we are in it.
import {
  Role, type FromLink, type LessonView, type RemarkView, type ScenePictureView, type SceneView, type StatusView, type ToolView, type ViewerView,
} from './shared/messages';

export type Connection =
  | { state: 'opening' }
  | { state: 'open' }
  | { state: 'away'; reason: string; sinceMs: number; nextTryMs: number }
  | { state: 'refused'; reason: string };

// A viewer that has said nothing for so long is gone; it speaks about once per second.
const kSilentMs = 4000;
const kAlertMs = 500;

export class Session {
  connection: Connection = { state: 'opening' };
  role: Role = Role.Viewer;
  name = '';
  sender = '';
  expiresMs = 0;  // of the invitation; 0: it does not end
  hasServer = false;
  hasEnded = false;
  scene?: SceneView;
  tool?: ToolView;
  status?: StatusView;
  lesson?: LessonView;
  nodes = 0;  // shown
  hasBeenComplete = false;  // since this run of the server began; milling changes the count faster than it is told
  readonly viewers = new Map<string, { viewer: ViewerView; heardMs: number }>();
  readonly remarks = new Map<string, RemarkView>();
  private readonly pictures = new Map<number, ScenePictureView>();  // of the lesson's scenes
  private events = 0;
  private eventsUntil = 0;
  private eventStructure = 0;

  take(message: FromLink, now: number): void {
    switch (message.kind) {
      case 'away':
        this.connection = { state: 'away', reason: message.reason, sinceMs: message.sinceMs, nextTryMs: message.nextTryMs };
        break;
      case 'refused':
        this.connection = { state: 'refused', reason: message.reason };
        break;
      case 'welcome':
        this.connection = { state: 'open' };
        ({ role: this.role, name: this.name, sender: this.sender, expiresMs: this.expiresMs } = message);
        // What was erased, and who has left meanwhile, nobody tells.
        this.remarks.clear();
        this.viewers.clear();
        break;
      case 'server':
        ({ hasServer: this.hasServer, hasEnded: this.hasEnded } = message);
        break;
      case 'epoch':
        this.scene = this.tool = this.status = this.lesson = undefined;
        this.nodes = 0;
        this.hasBeenComplete = false;
        this.remarks.clear();
        this.pictures.clear();
        break;
      case 'scene':
        this.scene = message.scene;
        break;
      case 'tool':
        this.takeTool(message.tool, now);
        break;
      case 'status':
        this.status = message.status;
        this.showNodes(this.nodes);
        break;
      case 'lesson':
        this.lesson = message.lesson;
        this.showPictures();
        break;
      case 'picture':
        this.pictures.set(message.scene, message.picture);
        this.showPictures();
        break;
      case 'viewer':
        if (message.viewer) this.viewers.set(message.sender, { viewer: message.viewer, heardMs: now });
        else this.viewers.delete(message.sender);
        break;
      case 'remark':
        if (message.remark) this.remarks.set(message.key, message.remark);
        else this.remarks.delete(message.key);
        break;
    }
  }

  // So many nodes are shown now.
  showNodes(count: number): void {
    this.nodes = count;
    this.hasBeenComplete ||= this.isComplete;
  }

  // They come by themselves.
  private showPictures(): void {
    for (const [scene, { sceneId, png }] of this.pictures) {
      const choice = this.lesson?.scenes[scene];
      if (choice?.id === sceneId) choice.picture = png;
    }
  }

  private takeTool(tool: ToolView, now: number): void {
    if (this.scene && tool.epoch !== this.scene.epoch) return;
    this.tool = tool;
    const events = tool.effects?.events ?? 0;
    if (events === 0) return;
    this.events = now < this.eventsUntil ? this.events | events : events;
    this.eventsUntil = now + kAlertMs;
    if (tool.effects?.eventId) this.eventStructure = tool.effects.eventId;
  }

  // What an effect has reported lately: for half a second at least, so that it is seen.
  alert(now: number): { events: number; structure: number } {
    return { events: now < this.eventsUntil ? this.events : 0, structure: this.eventStructure };
  }

  others(now: number): ViewerView[] {
    for (const [sender, { heardMs }] of this.viewers) if (now - heardMs > kSilentMs) this.viewers.delete(sender);
    return [...this.viewers.values()].map(({ viewer }) => viewer).filter((viewer) => viewer.sender !== this.sender);
  }

  get isLive(): boolean {
    return this.connection.state === 'open' && this.hasServer;
  }
  // Connected, and all of the bone has been seen.
  get isShown(): boolean {
    return this.isLive && !this.hasEnded && this.hasBeenComplete;
  }
  get isComplete(): boolean {
    return this.status !== undefined && !this.status.isModelPartial && this.nodes === this.status.nodeCount;
  }
}
