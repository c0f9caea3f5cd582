// What keys do.
import type { OrderDesk } from '../orders';
import { kPresets, actionOf, type Action } from './key_table';
import type { Session } from '../session';
import type { ToolHold } from '../tool_hold';
import type { Orbit } from '../view/camera';
import { nextStructureMode, type ViewSettings } from '../view_settings';

export interface KeyActs {
  session: Session;
  settings: ViewSettings;
  desk: OrderDesk;
  hold: ToolHold;
  orbit(): Orbit;
  moved(): void;
  changed(): void;
  firstView(): void;
  say(text: string): void;
  togglePanel(): void;
  toggleHelp(): void;
  toggleSound(): void;
  holdOrLetGo(): void;
  toolSteps(steps: number): void;
  pointWhileHeld(is_held: boolean): void;
  look(): void;
}

const kStep = (5 * Math.PI) / 180, kZoom = 1.1, kCutStep = 0.02, kTextStep = 1.1;

export class Keyboard {
  constructor(private readonly acts: KeyActs) {
    document.addEventListener('keydown', (event) => this.onKey(event, true));
    document.addEventListener('keyup', (event) => this.onKey(event, false));
    window.addEventListener('blur', () => {
      acts.hold.releaseAll();
      acts.pointWhileHeld(false);
    });
  }

  private onKey(event: KeyboardEvent, is_down: boolean): void {
    const target = event.target as HTMLElement;
    if (is_down && /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName)) return;
    const key = event.key.toLowerCase(), { hold } = this.acts;
    if (key === 'l' && !event.shiftKey && !event.ctrlKey && !event.repeat) return this.acts.pointWhileHeld(is_down);
    const held = ({ b: 'mill', a: 'add', v: 'turn', ' ': 'clutch' } as const)[key as 'b'];
    if (held && hold.isHolding && !event.ctrlKey) {
      hold.keys[held] = is_down;
      event.preventDefault();
      return;
    }
    if (target.tagName === 'BUTTON' && (key === ' ' || key === 'enter')) return;
    const action = is_down ? actionOf(event) : undefined;
    if (!action) return;
    event.preventDefault();
    this.act(action);
  }

  private act(action: Action): void {
    const { settings, desk, changed } = this.acts;
    const cut = action.match(/^(cut|flip)([XYZ])$/);
    if (cut) return this.cut('XYZ'.indexOf(cut[2]), cut[1] === 'flip');
    const accuracy = action.match(/^accuracy(\d)$/);
    if (accuracy) return desk.give({ action: 'setAccuracy', value: kPresets[Number(accuracy[1])] });
    if (/^(orbit|zoom)/.test(action)) return this.move(action);
    switch (action) {
      case 'firstView': return this.acts.firstView();
      case 'cutLower': return this.moveCut(-kCutStep);
      case 'cutHigher': return this.moveCut(kCutStep);
      case 'transparency': settings.isTransparent = !settings.isTransparent; return changed();
      case 'structures': settings.structures = nextStructureMode(settings.structures); return changed();
      case 'endoscope': settings.isEndoscope = !settings.isEndoscope; return changed();
      case 'forceArrow': settings.showsForce = !settings.showsForce; return changed();
      case 'figures': settings.showsFigures = !settings.showsFigures; return changed();
      case 'details': settings.showsDetails = !settings.showsDetails; return changed();
      case 'remarks': settings.showsRemarks = !settings.showsRemarks; return changed();
      case 'largerText': settings.textScale = Math.min(settings.textScale * kTextStep, 3); return changed();
      case 'smallerText': settings.textScale = Math.max(settings.textScale / kTextStep, 0.6); return changed();
      case 'panel': return this.acts.togglePanel();
      case 'help': return this.acts.toggleHelp();
      case 'sound': return this.acts.toggleSound();
      case 'look': return this.acts.look();
      case 'pause': return desk.pauseOrGoOn();
      case 'resetBone': return desk.give({ action: 'resetVolume' });
      case 'saveCheckpoint': return desk.give({ action: 'saveCheckpoint' });
      case 'lastCheckpoint': return desk.backToLastCheckpoint();
      case 'nextTool': return desk.nextTool();
      case 'resetDevice': return desk.give({ action: 'resetDevice' });
      case 'again': return desk.give({ action: 'beginAgain' });
      case 'nextScene': return desk.nextScene();
      case 'stopAttempt': return desk.stopAttempt();
      case 'holdTool': return this.acts.holdOrLetGo();
      case 'toolDeeper': return this.acts.hold.isHolding ? this.acts.toolSteps(1) : undefined;
      case 'toolNearer': return this.acts.hold.isHolding ? this.acts.toolSteps(-1) : undefined;
    }
  }

  private cut(axis: number, is_flip: boolean): void {
    const cut = this.acts.settings.cuts[axis];
    if (is_flip) cut.isFlipped = !cut.isFlipped;
    else cut.isOn = !cut.isOn;
    this.acts.settings.lastCut = axis;
    this.acts.changed();
  }

  private moveCut(step: number): void {
    const cut = this.acts.settings.cuts[this.acts.settings.lastCut];
    cut.position = Math.min(Math.max(cut.position + step, 0), 1);
    this.acts.changed();
  }

  private move(action: Action): void {
    const orbit = this.acts.orbit();
    if (action === 'zoomIn' || action === 'zoomOut') orbit.zoom(action === 'zoomIn' ? 1 / kZoom : kZoom);
    const turns: Partial<Record<Action, [number, number]>> = {
      orbitLeft: [-kStep, 0], orbitRight: [kStep, 0], orbitUp: [0, kStep], orbitDown: [0, -kStep],
    };
    const turn = turns[action];
    if (turn) orbit.turn(...turn);
    this.acts.moved();
  }
}
