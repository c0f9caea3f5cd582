// The panel's parts about the session: lesson, orders, who is watching, notes.
import { clockText, figureText, readableText } from '../shared/format';
import { mayOrder } from '../shared/commands';
import { tr } from '../shared/language';
import { type AttemptView, type CommandOrder, type LessonView, type SceneChoiceView } from '../shared/messages';
import type { OrderDesk } from '../orders';
import { whyNot } from '../orders';
import type { Session } from '../session';
import type { ViewSettings } from '../view_settings';
import { button, make } from './dom';
import { keyText, kPresets } from './key_table';
import { choice, disabledFor, pressed, row, say, type Section } from './panel';
import { kRoleNames, titleOf, trainingRows } from './words';

export interface SessionActs {
  session: Session;
  desk: OrderDesk;
  settings: ViewSettings;
  follow(sender: string): void;
  writeNote(): void;
}

function orderButton(acts: SessionActs, text: string, title: string, order: CommandOrder): HTMLButtonElement {
  return disabledFor(button(text, title, () => acts.desk.give(order)), whyNot(order.action, acts.session));
}

// Of the role and of whether there is a server.
const permission = ({ session }: SessionActs) => [session.role, session.isLive];

export function lessonSection(acts: SessionActs): Section {
  const { session } = acts;
  return {
    title: tr('Lesson'),
    key: () => {
      const lesson = session.lesson;
      if (!lesson || lesson.scenes.length === 0) return undefined;
      return [lesson.scenes.map((scene) => [scene.id, scene.title, scene.problem, scene.isMadeFirst, scene.task, scene.picture?.length]), lesson.sceneId,
        lesson.isRunning, lesson.trainee, lesson.attempts.length, permission(acts)];
    },
    content: () => {
      const lesson = session.lesson!, name = make('input');
      name.type = 'text';
      name.maxLength = 64;
      name.placeholder = tr("Trainee's name or number");
      name.value = lesson.isRunning ? lesson.trainee : '';
      name.setAttribute('aria-label', name.placeholder);
      const start = () => {
        const trainee = name.value.trim();
        name.blur();
        acts.desk.give({ action: 'startAttempt', value: trainee });
      };
      name.addEventListener('keydown', (event) => {
        if (event.key === 'Enter') start();
      });
      const may = whyNot('startAttempt', session);
      name.disabled = may !== '';
      const buttons = lesson.isRunning
        ? row(say(tr('{1} is at it', lesson.trainee)), orderButton(acts, tr('End attempt'), keyText('Shift+F'), { action: 'stopAttempt' }))
        : row(name, disabledFor(button(tr('Start'), tr('begins an attempt on whole bone'), start), may));
      return [buttons, ...lesson.scenes.map((scene) => sceneCard(acts, scene)), ...lesson.attempts.slice(-5).reverse().map((one) => attemptCard(one, lesson))];
    },
  };
}

function sceneCard(acts: SessionActs, scene: SceneChoiceView): HTMLElement {
  const is_chosen = scene.id === acts.session.lesson?.sceneId;
  const card = make('div', { name: is_chosen ? 'card chosen' : 'card' });
  if (scene.picture) {
    const picture = make('img');
    picture.alt = '';
    const url = URL.createObjectURL(new Blob([scene.picture as BlobPart], { type: 'image/png' }));
    picture.onload = picture.onerror = () => URL.revokeObjectURL(url);
    picture.src = url;
    card.append(picture);
  }
  const about = [scene.tools.join(', '), scene.expectedS > 0 ? tr('about {1} min', Math.round(scene.expectedS / 60)) : ''];
  card.append(make('strong', { text: scene.title || scene.id }), say(scene.task), say(about.filter(Boolean).join(' · ')));
  if (scene.problem) card.append(say(scene.problem, 'warning'));
  if (scene.isMadeFirst) card.append(say(tr('Its bone is made first: some seconds')));
  if (!scene.problem && !is_chosen) card.append(orderButton(acts, tr('Choose'), tr('changes to this scene'), { action: 'chooseScene', value: scene.id }));
  return card;
}

function attemptCard(attempt: AttemptView, lesson: LessonView): HTMLElement {
  const rows = [
    [tr('Time'), clockText(attempt.timeS)], [tr('Removed'), readableText(attempt.removedMm3, ' mm³')],
    [tr('Highest force'), readableText(attempt.maxForceN, ' N')],
    ...(attempt.training ? trainingRows(attempt.training).map((one) => [one.label, one.value]) : []),
  ];
  if (attempt.structuresTouched.length > 0) rows.push([tr('Touched'), attempt.structuresTouched.join(', ')]);
  const list = make('dl', {}, ...rows.flatMap(([label, value]) => [make('dt', { text: label }), make('dd', { text: value })]));
  return make('div', { name: 'card' }, make('strong', { text: `${attempt.number}. ${attempt.trainee}, ${titleOf(lesson, attempt.sceneId)}` }), list);
}

export function ordersSection(acts: SessionActs): Section {
  const { session, desk } = acts;
  return {
    title: tr('Session'),
    key: () => {
      const { status, scene } = session;
      return [permission(acts), session.name, status?.isMillingPaused, status?.checkpoints, scene?.toolNames,
        scene?.toolIndex, status?.preset, status?.device?.script];
    },
    content: () => {
      const { status, scene } = session, why = whyNot('pauseMilling', session), role = tr(kRoleNames[session.role]);
      const who = say(`${tr('You are {1}.', session.name ? `${session.name}, ${role}` : role)}${why ? ` ${why}.` : ''}`);
      const end = session.expiresMs > 0 ? [say(tr('Your invitation ends on {1}.', new Date(session.expiresMs).toLocaleString(document.documentElement.lang)))] : [];
      const pause = button(status?.isMillingPaused ? tr('Go on') : tr('Pause'), 'P', () => desk.pauseOrGoOn());
      const parts: Node[] = [who, ...end, row(
        disabledFor(pause, why),
        orderButton(acts, tr('Put the bone back'), 'C', { action: 'resetVolume' }),
        orderButton(acts, tr('Save a checkpoint'), 'K', { action: 'saveCheckpoint' }),
        orderButton(acts, tr('Reset the device'), 'D', { action: 'resetDevice' }),
      )];
      const script = status?.device?.script;
      if (script)
        parts.push(row(
          orderButton(acts, tr('Again'), keyText('Shift+C'), { action: 'beginAgain' }),
          ...(script.hasEnded ? [orderButton(acts, tr('Take over'), 'G', { action: 'takeOver' })] : []),
        ));
      const checkpoints = status?.checkpoints ?? [];
      if (checkpoints.length > 0)
        parts.push(row(...checkpoints.map((one) => orderButton(acts, tr('Back to {1}', one.id),
          `${clockText(one.sessionS)}, ${readableText(one.removedMm3, ' mm³')}`, { action: 'restoreCheckpoint', value: one.id }))));
      if (scene && scene.toolNames.length > 1)
        parts.push(choice(tr('Tool'), scene.toolNames, scene.toolIndex, whyNot('selectTool', session), (i) => desk.give({ action: 'selectTool', value: i })));
      parts.push(choice(tr('Accuracy'), kPresets, kPresets.indexOf(status?.preset ?? ''), whyNot('setAccuracy', session),
        (i) => desk.give({ action: 'setAccuracy', value: kPresets[i] })));
      parts.push(row(orderButton(acts, tr('End the session'), tr('for everyone; asked twice'), { action: 'shutDown' })));
      return parts;
    },
  };
}

export function watchersSection(acts: SessionActs): Section {
  const { session, settings } = acts;
  const listed = () => session.others(Date.now()).map((one) => ({ ...one, pointer: undefined, frameRateHz: Math.round(one.frameRateHz), camera: one.camera !== undefined }));
  return {
    title: tr('Who is watching'),
    key: () => [listed(), settings.following],
    content: () => {
      const cards = listed().map((one) => {
        const about = [tr(kRoleNames[one.role]), figureText(one.frameRateHz, 0, ' Hz'), one.link,
          one.isHolding ? tr('holds the tool') : '', one.isComplete ? '' : tr('incomplete')];
        const line = row(make('strong', { text: one.name || tr('(no name)') }), make('span', { text: about.filter(Boolean).join(', ') }));
        const is_followed = settings.following === one.sender;
        if (one.camera)
          line.append(pressed(button(is_followed ? tr('Stop following') : tr('Follow'), tr('shows what they look at'),
            () => acts.follow(is_followed ? '' : one.sender)), is_followed));
        return line;
      });
      return cards.length > 0 ? cards : [say(tr('Nobody else is here.'))];
    },
  };
}

export function remarksSection(acts: SessionActs): Section {
  const { session } = acts;
  const listed = () => [...session.remarks.values()].sort((a, b) => a.number - b.number);
  return {
    title: tr('Notes and strokes'),
    key: () => [listed().map((one) => one.number), permission(acts)],
    content: () => {
      const why = whyNot('addRemark', session);
      const parts: Node[] = [row(
        disabledFor(button(tr('Write a note'), tr('for everyone, with the time'), () => acts.writeNote()), why),
        orderButton(acts, tr('Erase all'), tr('asked twice'), { action: 'eraseRemark', value: 0 }),
      )];
      for (const one of listed().slice(-40).reverse()) {
        const swatch = make('span', { name: 'swatch' });
        swatch.style.backgroundColor = `rgb(${one.colour.map((part) => Math.round(255 * part)).join(' ')})`;
        const text = make('span', { text: `${clockText(one.sessionS)} ${one.author || tr(kRoleNames[one.role])}: ${one.note || tr('a stroke')}` });
        const erase = orderButton(acts, tr('Erase'), tr('Takes it away, for everybody'), { action: 'eraseRemark', value: one.number });
        parts.push(row(...(one.points.length > 1 ? [swatch] : []), text, ...(mayOrder(session.role, 'eraseRemark') ? [erase] : [])));
      }
      return parts;
    },
  };
}
