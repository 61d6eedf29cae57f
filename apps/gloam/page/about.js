// Head of the page, and its end: what was compared, and the commands that repeat it.

/// As the terminal's remark: errors that are to a good part the noise of the light that a technique is held to.
function noiseSentence(ranked) {
  const hidden = ranked.filter(({technique, error}) => technique.reference_noise !== null && Math.sqrt(error) < 1.5 * technique.reference_noise);
  if (hidden.length === 0) return '';
  const said = hidden.map(({technique}) => `${technique.label} (${percent(technique.reference_noise)})`).join(', ');
  return ` Not clearly off by more than the noise of what ${hidden.length === 1 ? 'it is' : 'they are'} held to: ${said}; a reference of more samples tells more.`;
}

function sentence() {
  const ranked = results.techniques.map((technique) => ({technique, error: technique.relative_squared_error}))
    .filter(({error}) => error !== null).sort((a, b) => a.error - b.error);
  if (ranked.length === 0) return '';
  const say = ({technique, error}, verb) => `${technique.label}${verb} by ${percent(Math.sqrt(error))} (FLIP ${significant(technique.flip)}, ${milliseconds(technique.device_ms)} a frame)`;
  const [first, ...rest] = ranked;
  const chance = noiseSentence(ranked);
  if (rest.length < 2) return `${say(first, ' differs from its reference')}${rest.length ? `, ${say(rest[0], '')}` : ''}.${chance}`;
  return `Of ${ranked.length}, ${say(first, ' is nearest to its reference, off')}; ${say(rest[rest.length - 1], ' is off')}.${chance}`;
}

function buildHead() {
  byId('title').textContent = page.title;
  const leaf = (path) => path.split('/').pop();
  const facts = [leaf(results.scene), results.environment ? `light: ${leaf(results.environment)}` : 'no light from afar', `${results.size.replace('x', ' × ')} pixels`,
    bouncesText(results.bounces), results.device];
  byId('facts').append(...facts.map((fact) => make('span', {}, fact)));
  byId('headline').textContent = sentence();
}

function commandLine(command) {
  const button = make('button', {type: 'button', 'aria-label': `Copy: ${command}`, onclick: async () => {
    await navigator.clipboard.writeText(command);
    button.textContent = 'Copied';
    setTimeout(() => { button.textContent = 'Copy'; }, 1500);
  }}, 'Copy');
  return make('div', {class: 'command'}, make('code', {}, command), navigator.clipboard ? button : null);
}

function buildAbout() {
  const reference = results.reference;
  const about = byId('about');
  about.append(make('p', {}, 'Each technique is held against a path-traced reference of the same scene, camera, light and materials that holds only the light '
    + 'which the technique covers, after as many bounces. The light behind the scene is left out of pictures and measures, and what shines itself out of measures.'));
  const facts = [['scene', results.scene], ...(results.environment ? [['light', results.environment]] : []), ['reference', reference.text], ...(reference.relative_noise !== null ? [['noise', `makes ${percent(reference.relative_noise)} relative error by itself, of all light; that of what each technique is held to is dashed in the plot`]] : []),
    ...(results.environment_order > 0 ? [['its light', `the environment’s projection to ${results.environment_order} bands of spherical harmonics`]] : []),
    ['page', page.shrink > 1 ? `pictures here at 1/${page.shrink} of their size; all measures are of the full size` : 'pictures in full size, linear half floats; all light is the sum of its two layers'],
    ['gloam', results.version]];
  about.append(make('dl', {}, facts.flatMap(([term, text]) => [make('dt', {}, term), make('dd', {}, text)])));
  about.append(make('h3', {}, 'This page'), commandLine(results.command), make('h3', {}, 'Its numbers, one technique a line'),
    ...results.techniques.map((technique) => commandLine(technique.command)));
  const notes = results.techniques.flatMap((technique) => technique.notes.map((note) => `${technique.label}: ${note}`));
  if (notes.length) about.append(make('h3', {}, 'Remarks'), make('ul', {}, notes.map((note) => make('li', {}, note))));
  byId('footer').textContent = 'Made by gloam compare. This file is complete in itself: it loads nothing and sends nothing. results.json and results.csv beside it hold the same numbers.';
}
