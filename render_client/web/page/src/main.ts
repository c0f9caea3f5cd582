// The page: brings together the link (a worker), the picture, and what the user does.
import { mayOrder, mayPoint, orderText } from './shared/commands';
import { addressIn, chosenLanguage, loadLanguage, tr, trMark } from './shared/language';
import { CommandOrder, FromLink, ToLink } from './shared/messages';
import { hasTakenOver, kPointerDevice, OrderDesk, whyNot, whyNotHold, whyNotPoint, whyNotTakeOver } from './orders';
import { Session } from './session';
import { SoundPlayer } from './sound/sound_player';
import { Stage } from './stage';
import { keepTicket, takeToken } from './token';
import { beginInFrontOf, ToolHold, type Place } from './tool_hold';
import { Announcer } from './announcer';
import { button, byId } from './ui/dom';
import { toggleHelp } from './ui/help';
import { Hud } from './ui/hud';
import { askForNote } from './ui/note_form';
import { Panel, pressed } from './ui/panel';
import { PictureInput } from './ui/picture_input';
import { Keyboard } from './ui/keyboard';
import { keyText } from './ui/key_table';
import { languageSection } from './ui/language_section';
import { viewSection } from './ui/view_section';
import { lessonSection, ordersSection, remarksSection, watchersSection } from './ui/session_sections';
import { StrokePen } from './stroke_pen';
import { firstSettings, type DragMode } from './view_settings';
import { add, centreOf, cornersOf, norm, normalized, placed, scale, sub, boxAround, radiusOf, type Vec3 } from './math/linear';

document.documentElement.lang = await loadLanguage(chosenLanguage(location.search, navigator.languages));
for (const [id, name] of [['picture', tr('The bone and the tool')], ['figures', tr('Figures')], ['bar', tr('Tools')], ['panel', tr('Control panel')]])
  byId(id).setAttribute('aria-label', name);
const session = new Session(), settings = firstSettings(), hold = new ToolHold(), hud = new Hud(), sound = new SoundPlayer();
const canvas = byId<HTMLCanvasElement>('picture');
const token = takeToken();
const link = new Worker('link.js', { type: 'module', name: 'link' });
const tell = (message: ToLink) => link.postMessage(message);
const say = (text: string, tone?: 'warning' | 'alarm') => {
  hud.say(text, tone);
  refresh();
};
const send = (order: CommandOrder) => tell({ kind: 'command', order });
const desk = new OrderDesk(session, send, say);
const stage = new Stage(canvas, session, settings, hold, onPicture);
const pen = new StrokePen(stage, send);
const announcer = new Announcer(session, stage, hold, tell);

function follow(sender: string): void {
  settings.following = sender;
  if (sender) settings.isEndoscope = false;
  takeFollowed();
  refresh();
}

// Whoever moves the view goes their own way again.
function moved(): void {
  if (settings.following) say(tr('You look for yourself again'));
  settings.following = '';
  stage.invalidate(true);
}

function takeFollowed(): void {
  const camera = session.viewers.get(settings.following)?.viewer.camera;
  if (!camera || !(camera.distance > 0) || !camera.target) return;
  Object.assign(stage.orbit, { target: camera.target, distance: camera.distance, azimuth: camera.azimuth, elevation: camera.elevation });
  if (camera.up && norm(camera.up) > 1e-9) stage.orbit.up = normalized(camera.up);
  stage.orbit.turn(0, 0);
  stage.orbit.zoom(1);
  stage.invalidate(true);
}

const acts = { session, desk, settings, follow, writeNote: () => askForNote((note) => remark(note, [])) };
const panel = new Panel([
  lessonSection(acts), ordersSection(acts), viewSection(session, settings, changed, firstView), watchersSection(acts),
  remarksSection(acts), languageSection(document.documentElement.lang, (code) => location.assign(addressIn(code, location.href))),
]);

function remark(note: string, points: Vec3[]): void {
  desk.give({ action: 'addRemark', note, points, colour: 0xffd23f });
}

function firstView(): void {
  settings.following = '';
  stage.firstView();
}

// What is shown was chosen anew.
function changed(): void {
  document.documentElement.style.fontSize = settings.textScale === 1 ? '' : `${15 * settings.textScale}px`;
  stage.invalidate(true);
  refresh();
}

function setMode(mode: DragMode): void {
  const why = mode === 'point' ? whyNotPoint(session) : mode === 'look' ? '' : whyNot('addRemark', session);
  if (why) return say(why, 'warning');
  settings.mode = settings.mode === mode ? 'look' : mode;
  refresh();
}

function point(at: Place | undefined): void {
  const why = whyNotPoint(session);
  if (at && why) return say(why, 'warning');
  stage.ownPointer = at && stage.pick(at);
  stage.invalidate();
}

// The bone under the cursor, or else the bone on the line of sight through its middle.
function surfaceInView(at?: Place): Vec3 {
  const scene = session.scene, under = at && stage.pick(at);
  if (under || !scene) return under ?? stage.orbit.target;
  const box = boxAround(cornersOf({ low: scene.boneLow, high: scene.boneHigh }).map((corner) => placed(scene.X_WV, corner)));
  const middle = stage.pick({ x: canvas.clientWidth / 2, y: canvas.clientHeight / 2 });
  const towards_eye = normalized(sub(stage.camera().eye, centreOf(box)));
  return middle ?? add(centreOf(box), scale(towards_eye, radiusOf(box)));
}

function holdOrLetGo(at?: Place): void {
  if (hold.isHolding) {
    hold.letGo();
  } else {
    if (!whyNotTakeOver(session)) return desk.give({ action: 'takeOver' });
    const why = whyNotHold(session, Date.now());
    if (why) return say(why, 'warning');
    const burr = session.scene?.burrRadius || 1e-3;
    hold.begin(beginInFrontOf(surfaceInView(at), stage.camera(), burr, session.tool?.X_WT_device), burr, true);
    say(tr('The mouse holds the tool: left mills, right turns, the wheel goes deeper, G lets go'));
  }
  stage.invalidate();
  refresh();
}

const input = new PictureInput(canvas, {
  mode: () => settings.mode,
  isHolding: () => hold.isHolding && !hold.keys.clutch,
  orbit: (right, down) => {
    const turn = Math.PI / canvas.clientHeight;
    stage.orbit.turn(-right * turn, down * turn);
    moved();
  },
  pan: (right, down) => {
    stage.orbit.pan(right / canvas.clientHeight, -down / canvas.clientHeight);
    moved();
  },
  zoom: (factor) => {
    stage.orbit.zoom(factor);
    moved();
  },
  target: (at) => {
    const p = stage.pick(at);
    if (!p) return;
    stage.orbit.target = p;
    moved();
  },
  point,
  stroke: (at, phase) => {
    const why = whyNot('addRemark', session);
    if (why) return say(why, 'warning');
    pen.move(at, phase);
  },
  note: (at) => {
    const p = stage.pick(at);
    if (p) askForNote((note) => remark(note, [p]));
  },
  toolMove: (from, to) => {
    hold.move(stage.look(), from, to);
    stage.invalidate();
  },
  toolButton: (which, is_down) => {
    hold.buttonsDown[which] = is_down;
    stage.invalidate();
  },
  toolWheel: (steps) => {
    hold.moveAlongSight(stage.look(), steps);
    stage.invalidate();
  },
});

new Keyboard({
  session, settings, desk, hold, orbit: () => stage.orbit, moved, changed, firstView, say,
  togglePanel: () => panel.toggle(),
  toggleHelp,
  toggleSound,
  holdOrLetGo: () => holdOrLetGo(input.cursor),
  toolSteps: (steps) => {
    hold.moveAlongSight(stage.look(), steps);
    stage.invalidate();
  },
  pointWhileHeld: (is_held) => {
    input.pointsByKey = is_held;
    point(is_held ? input.cursor : undefined);
  },
  look: () => {
    settings.mode = 'look';
    byId('help').hidden = true;
    refresh();
  },
});

function toggleSound(): void {
  if (!SoundPlayer.isOffered(session)) return say(tr('This scene has no sound'));
  sound.toggle().catch(() => say(tr('This browser plays no sound'), 'warning')).finally(refresh);
}

// The buttons over the picture.
function drawBar(): void {
  const modes: [DragMode, string, string, boolean][] = [
    ['point', tr('Point'), tr('the laser goes where you drag'), mayPoint(session.role)],
    ['draw', tr('Draw'), tr('draws on the bone, for everyone'), mayOrder(session.role, 'addRemark')],
    ['note', tr('Note'), tr('tap on the bone and write'), mayOrder(session.role, 'addRemark')],
  ];
  const buttons = modes.filter((one) => one[3]).map(([mode, text, title]) => pressed(button(text, title, () => setMode(mode)), settings.mode === mode));
  if (SoundPlayer.isOffered(session)) buttons.push(pressed(button(tr('Sound'), keyText('Shift+M'), toggleSound), sound.isOn));
  if (session.status?.device?.kind === kPointerDevice && !whyNot('selectTool', session))
    buttons.push(pressed(button(tr('Hold the tool'), 'G', () => holdOrLetGo()), hold.isHolding));
  if (!whyNotTakeOver(session))
    buttons.push(button(tr('Again'), tr('whole bone, the scripted hand anew'), () => desk.give({ action: 'beginAgain' })),
      button(tr('Take over'), tr('The tool comes to your mouse'), () => holdOrLetGo()));
  const bar = byId('bar'), key = JSON.stringify(buttons.map((one) => [one.textContent, one.ariaPressed]));
  if (bar.dataset.key === key) return;
  bar.dataset.key = key;
  bar.replaceChildren(...buttons, button('?', tr('H: help'), toggleHelp), button('☰', tr('M: control panel'), () => panel.toggle()));
}

function refresh(): void {
  hud.update(session, settings, stage.pace.rate(performance.now()), stage.nodes, stage.triangles);
  drawBar();
  panel.update();
}

function onPicture(): void {
  if (hold.isHolding) tellHand();
}
function tellHand(): void {
  tell({ kind: 'hand', p: hold.wish.p, q: hold.wish.q, buttons: hold.buttons, isHolding: hold.isHolding });
}

let wasHolding = false, hadTakenOver = false;
// The mouse that comes in the place of a scripted hand is that of who has asked for it, until the script goes on.
function followTakeOver(): void {
  const has = hasTakenOver(session);
  if (has !== hadTakenOver && hold.isHolding !== has) holdOrLetGo(input.cursor);
  hadTakenOver = has;
}
function onTick(): void {
  followTakeOver();
  if (wasHolding && !hold.isHolding) tellHand();
  if (hold.isHolding) tellHand();
  wasHolding = hold.isHolding;
  announcer.step(performance.now());
  sound.update(session);
}

link.onmessage = (event: MessageEvent<FromLink>) => {
  const message = event.data;
  if (message.kind === 'frame') return tell({ kind: 'taken', bytes: message.bytes, connection: message.connection });
  session.take(message, Date.now());
  stage.take(message);
  switch (message.kind) {
    case 'welcome':
      return keepTicket(message.ticket);
    case 'refused':
      return keepTicket('');
    case 'viewer':
      if (message.sender === settings.following) takeFollowed();
      return;
    case 'outcome':
      return say(`${orderText(message.order)}: ${tr(message.result)}`, message.isDone ? undefined : 'warning');
    case 'away':
      hold.letGo();
  }
};
link.onerror = () => say(tr('The page could not start: load it again'), 'alarm');

setInterval(refresh, 200);
setInterval(onTick, 33);
document.addEventListener('visibilitychange', () => {
  if (!document.hidden) tell({ kind: 'retry' });
});
window.addEventListener('online', () => tell({ kind: 'retry' }));
if (token) tell({ kind: 'open', url: `${location.protocol === 'http:' ? 'ws' : 'wss'}://${location.host}/session`, token });
else session.take({ kind: 'refused', reason: trMark('This address needs an invitation: ask for a link, and open it whole.') }, Date.now());
refresh();
