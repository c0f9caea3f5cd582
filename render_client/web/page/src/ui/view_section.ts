// The panel's part about what is seen.
import type { Session } from '../session';
import type { ViewSettings } from '../view_settings';
import { nextStructureMode } from '../view_settings';
import { structureColour } from '../view/structure_colours';
import { tr, trIn, trMark } from '../shared/language';
import type { StructureMode } from '../view/picture_view';
import { button, make } from './dom';
import { keyText } from './key_table';
import { pressed, row, say, type Section } from './panel';

const kAxes = [trMark('X: left, right'), trMark('Y: front, back'), trMark('Z: head, feet')];
const kStructureWords = { behind: trMark('seen through all bone'), exposed: trMark('where exposed') };

const structureWords = (mode: StructureMode) => (mode === 'off' ? trIn('mode', 'off') : tr(kStructureWords[mode]));

function slider(label: string, value: number, change: (value: number) => void): HTMLInputElement {
  const input = make('input');
  input.type = 'range';
  input.min = '0';
  input.max = '1';
  input.step = '0.005';
  input.value = String(value);
  input.setAttribute('aria-label', label);
  input.addEventListener('input', () => change(Number(input.value)));
  return input;
}

export function viewSection(session: Session, settings: ViewSettings, changed: () => void, firstView: () => void): Section {
  const toggle = (text: string, title: string, is_on: boolean, flip: () => void) =>
    pressed(button(text, title, () => {
      flip();
      changed();
    }), is_on);
  return {
    title: tr('View'),
    key: () => [settings.cuts.map((cut) => [cut.isOn, cut.isFlipped]), settings.isTransparent, settings.structures,
      settings.isEndoscope, settings.showsForce, settings.showsFigures, settings.showsDetails, settings.showsRemarks,
      session.scene?.epoch, session.scene?.materials.map((material) => material.isProtected)],
    content: () => {
      const parts: Node[] = [row(
        button(tr('First view'), 'R', firstView),
        toggle(tr('Endoscope'), tr('E: the eye rides on the tool'), settings.isEndoscope, () => (settings.isEndoscope = !settings.isEndoscope)),
        toggle(tr('Force'), 'F', settings.showsForce, () => (settings.showsForce = !settings.showsForce)),
        toggle(tr('Figures'), keyText('Shift+H'), settings.showsFigures, () => (settings.showsFigures = !settings.showsFigures)),
        toggle(tr('All figures'), keyText('Shift+I'), settings.showsDetails, () => (settings.showsDetails = !settings.showsDetails)),
        toggle(tr('Notes'), keyText('Shift+R'), settings.showsRemarks, () => (settings.showsRemarks = !settings.showsRemarks)),
      ), say(tr('Cut-planes'))];
      settings.cuts.forEach((cut, i) => parts.push(row(
        toggle(tr(kAxes[i]), 'XYZ'[i], cut.isOn, () => {
          cut.isOn = !cut.isOn;
          settings.lastCut = i;
        }),
        ...(cut.isOn ? [
          slider(tr(kAxes[i]), cut.position, (value) => {
            cut.position = value;
            settings.lastCut = i;
            changed();
          }),
          toggle('⇄', tr('cut away the other side'), cut.isFlipped, () => (cut.isFlipped = !cut.isFlipped)),
        ] : []),
      )));
      parts.push(row(
        toggle(tr('Transparent bone'), 'T', settings.isTransparent, () => (settings.isTransparent = !settings.isTransparent)),
        ...(settings.isTransparent ? [slider(tr('opacity'), settings.opacity, (value) => {
          settings.opacity = value;
          changed();
        })] : []),
      ));
      const scene = session.scene, names = scene?.materials.flatMap((m, i) => (m.isProtected ? [[m.name, i + 1] as const] : [])) ?? [];
      if (scene && names.length > 0) {
        parts.push(row(make('span', { text: tr('Protected structures') }), button(structureWords(settings.structures), keyText('Shift+T'), () => {
          settings.structures = nextStructureMode(settings.structures);
          changed();
        })));
        for (const [name, id] of names) {
          const swatch = make('span', { name: 'swatch' });
          swatch.style.backgroundColor = `rgb(${structureColour(scene, id).map((part) => Math.round(255 * part)).join(' ')})`;
          parts.push(row(swatch, make('span', { text: name || tr('material {1}', id) })));
        }
      }
      return parts;
    },
  };
}
