// Draws the program's figures: uPlot gives the frame, axes and pointer, the layers are drawn on it in the
// order of the program's data, in the colours of its report.
import uPlot from 'uplot';
import { el, setText, table } from './dom.js';
import { shown } from './numbers.js';

// matplotlib's viridis (van der Walt and Smith 2015, public domain), as in the report's heat maps.
const viridisKnots = ['440154', '482878', '3e4a89', '31688e', '26828e', '1f9e89', '35b779', '6ece58', 'b5de2b', 'fde725']
  .map((code) => [0, 2, 4].map((at) => parseInt(code.slice(at, at + 2), 16)));

function viridis(share) {
  const at = Math.min(1, Math.max(0, share)) * (viridisKnots.length - 1);
  const first = Math.min(Math.floor(at), viridisKnots.length - 2);
  return `rgb(${viridisKnots[first].map((lo, c) =>
    Math.round(lo + (at - first) * (viridisKnots[first + 1][c] - lo))).join(' ')})`;
}

let palette = {};
/** Takes the colours anew from the style, as after a change between light and dark. */
export function takeColours() {
  const style = getComputedStyle(document.documentElement);
  palette = {};
  for (const name of ['ink', 'orange', 'sky', 'green', 'blue', 'vermilion', 'purple', 'grey', 'paper', 'quiet', 'line']) {
    palette[name] = style.getPropertyValue(`--${name}`).trim();
  }
}
const colour = (name) => palette[name] ?? palette.ink;

const finite = (value) => typeof value === 'number' && Number.isFinite(value);

const painters = {
  span(ctx, u, { range, colour: name }) {
    const x0 = u.valToPos(Math.max(range.lo, u.scales.x.min), 'x', true);
    const x1 = u.valToPos(Math.min(range.hi, u.scales.x.max), 'x', true);
    ctx.globalAlpha *= 0.14;
    ctx.fillStyle = colour(name);
    ctx.fillRect(x0, u.bbox.top, x1 - x0, u.bbox.height);
  },
  band(ctx, u, { x, lower, upper, colour: name }) {
    ctx.globalAlpha *= 0.22;
    ctx.fillStyle = colour(name);
    ctx.beginPath();
    x.forEach((at, i) => ctx[i ? 'lineTo' : 'moveTo'](u.valToPos(at, 'x', true), u.valToPos(upper[i], 'y', true)));
    for (let i = x.length - 1; i >= 0; --i) ctx.lineTo(u.valToPos(x[i], 'x', true), u.valToPos(lower[i], 'y', true));
    ctx.fill();
  },
  curve(ctx, u, { x, y, colour: name, dash, width, label }, panel, labels) {
    ctx.strokeStyle = colour(name);
    ctx.lineWidth = (0.6 + 0.9 * (width ?? 1)) * devicePixelRatio;
    ctx.setLineDash((dash ?? []).map((length) => length * 1.3 * devicePixelRatio));
    ctx.lineJoin = 'round';
    ctx.beginPath();
    let down = false;
    for (let i = 0; i < x.length; ++i) {
      if (!finite(x[i]) || !finite(y[i])) { down = false; continue; }
      ctx[down ? 'lineTo' : 'moveTo'](u.valToPos(x[i], 'x', true), u.valToPos(y[i], 'y', true));
      down = true;
    }
    ctx.stroke();
    if (!label) return;
    const last = x.findLastIndex((at, i) => finite(at) && finite(y[i]));
    const end = u.valToPos(x[last], 'x', true);
    const right = end > u.bbox.left + u.bbox.width - 60 * devicePixelRatio;
    const height = Math.max(u.valToPos(y[last], 'y', true), u.bbox.top + 14 * devicePixelRatio);
    // What would cover an earlier one is told by the legend alone.
    const wide = (label.length * 7 + 3) * devicePixelRatio;
    const place = { from: right ? end - wide : end, to: right ? end : end + wide, height };
    if (labels.some(({ from, to, height: other }) => from < place.to && place.from < to && Math.abs(other - height) < 11 * devicePixelRatio)) return;
    labels.push(place);
    write(ctx, label, end + (right ? -3 : 3) * devicePixelRatio, height, right ? 'right' : 'left');
  },
  reference(ctx, u, { at, vertical, colour: name, dash, words }) {
    ctx.strokeStyle = colour(name);
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash((dash ?? []).map((length) => length * 1.3 * devicePixelRatio));
    ctx.beginPath();
    if (vertical) {
      const x = u.valToPos(at, 'x', true);
      ctx.moveTo(x, u.bbox.top);
      ctx.lineTo(x, u.bbox.top + u.bbox.height);
    } else {
      const y = u.valToPos(at, 'y', true);
      ctx.moveTo(u.bbox.left, y);
      ctx.lineTo(u.bbox.left + u.bbox.width, y);
    }
    ctx.stroke();
    if (vertical && words) {
      const x = u.valToPos(at, 'x', true);
      const left = x > u.bbox.left + u.bbox.width * 0.75;
      write(ctx, words, x + (left ? -4 : 4) * devicePixelRatio, u.bbox.top + u.bbox.height - 6 * devicePixelRatio,
        left ? 'right' : 'left');
    }
  },
  points(ctx, u, { x, y, mark, colour: name, sizes, values }, panel) {
    const r = devicePixelRatio * (mark === 'speck' ? 1.3 : mark === 'cross' ? 2 : 4.5);
    const scale = panel.scale?.range;
    for (let i = 0; i < x.length; ++i) {
      if (!finite(x[i]) || !finite(y[i])) continue;
      const tint = scale && values?.length ? viridis((values[i] - scale.lo) / (scale.hi - scale.lo || 1)) : colour(name);
      drawMark(ctx, u.valToPos(x[i], 'x', true), u.valToPos(y[i], 'y', true), r * (sizes?.[i] ?? 1), mark, tint);
    }
  },
  note(ctx, u, { x, y, words }) {
    write(ctx, words, u.valToPos(x, 'x', true), u.valToPos(y, 'y', true), 'center');
  },
  cells(ctx, u, { cells }, panel) {
    const scale = panel.scale?.range;
    for (const cell of cells) {
      ctx.fillStyle = finite(cell.value) && scale ? viridis((cell.value - scale.lo) / (scale.hi - scale.lo || 1)) : colour('grey');
      const x0 = u.valToPos(cell.x.lo, 'x', true), x1 = u.valToPos(cell.x.hi, 'x', true);
      const y0 = u.valToPos(cell.y.lo, 'y', true), y1 = u.valToPos(cell.y.hi, 'y', true);
      ctx.fillRect(x0, y1, x1 - x0 + 1, y0 - y1 + 1);
    }
  },
};

function drawMark(ctx, x, y, r, mark, tint) {
  ctx.strokeStyle = ctx.fillStyle = tint;
  ctx.lineWidth = 1.6 * devicePixelRatio;
  ctx.setLineDash([]);
  ctx.beginPath();
  if (mark === 'square') ctx.rect(x - r * 0.85, y - r * 0.85, r * 1.7, r * 1.7);
  else if (mark === 'diamond') [[0, -1.25], [1.25, 0], [0, 1.25], [-1.25, 0]].forEach(([dx, dy], i) => ctx[i ? 'lineTo' : 'moveTo'](x + r * dx, y + r * dy));
  else if (mark === 'triangle') [[0, -1.2], [1.1, 0.8], [-1.1, 0.8]].forEach(([dx, dy], i) => ctx[i ? 'lineTo' : 'moveTo'](x + r * dx, y + r * dy));
  else if (mark === 'plus' || mark === 'cross') {
    const [a, b] = mark === 'plus' ? [r, 0] : [r * 0.8, r * 0.8];
    ctx.moveTo(x - a, y - b); ctx.lineTo(x + a, y + b);
    ctx.moveTo(x + b, y - a); ctx.lineTo(x - b, y + a);
  } else ctx.arc(x, y, r, 0, 2 * Math.PI);
  if (mark === 'plus' || mark === 'cross') return ctx.stroke();
  ctx.closePath();
  if (mark === 'circle') {
    ctx.fillStyle = colour('paper');
    ctx.fill();
    ctx.stroke();
  } else ctx.fill();
}

function write(ctx, words, x, y, align) {
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textAlign = align;
  ctx.textBaseline = 'alphabetic';
  ctx.lineWidth = 3 * devicePixelRatio;
  ctx.setLineDash([]);
  ctx.strokeStyle = colour('paper');
  ctx.strokeText(words, x, y);
  ctx.fillStyle = colour('ink');
  ctx.fillText(words, x, y);
}

/** A short line or mark of the layer, for the legend. */
function sample(layer) {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  for (const [name, value] of Object.entries({ width: 26, height: 12, viewBox: '0 0 26 12', 'aria-hidden': 'true', class: `sample ${layer.colour ?? 'ink'}` })) svg.setAttribute(name, value);
  const add = (tag, attributes) => {
    const shape = document.createElementNS(space, tag);
    for (const [name, value] of Object.entries(attributes)) shape.setAttribute(name, value);
    svg.append(shape);
  };
  if (layer.kind === 'span' || layer.kind === 'band') add('rect', { x: 2, y: 1, width: 22, height: 10, fill: 'currentColor', opacity: 0.3 });
  else if (layer.kind === 'points') {
    if (layer.mark === 'plus') add('path', { d: 'M8 6H18M13 1V11', stroke: 'currentColor', 'stroke-width': 1.8 });
    else if (layer.mark === 'cross') add('path', { d: 'M10 3L16 9M16 3L10 9', stroke: 'currentColor', 'stroke-width': 1.4 });
    else if (layer.mark === 'square') add('rect', { x: 9, y: 2, width: 8, height: 8, fill: 'currentColor' });
    else if (layer.mark === 'diamond') add('path', { d: 'M13 1L18 6L13 11L8 6Z', fill: 'currentColor' });
    else if (layer.mark === 'triangle') add('path', { d: 'M13 1L18 10H8Z', fill: 'currentColor' });
    else add('circle', { cx: 13, cy: 6, r: layer.mark === 'speck' ? 1.5 : 4, fill: layer.mark === 'circle' ? 'none' : 'currentColor', stroke: 'currentColor', 'stroke-width': layer.mark === 'circle' ? 1.6 : 0 });
  } else add('line', { x1: 1, x2: 25, y1: 6, y2: 6, stroke: 'currentColor', 'stroke-width': 1 + 0.6 * (layer.width ?? 1), 'stroke-dasharray': (layer.dash ?? []).map((d) => d * 1.2).join(' ') || 'none' });
  return svg;
}

/** y of a curve at x, between its points; nothing outside or in a gap. */
function heightAt({ x, y }, at) {
  for (let i = 1; i < x.length; ++i) {
    const [a, b] = [x[i - 1], x[i]];
    if ((a - at) * (b - at) <= 0 && a !== b && finite(y[i - 1]) && finite(y[i])) {
      return y[i - 1] + (y[i] - y[i - 1]) * (at - a) / (b - a);
    }
  }
  return null;
}

/** Axis labels end in their unit: "thrust per motor (g)" → "g". */
const unitOf = (axis) => axis.label.match(/\(([^()]*)\)\s*$/)?.[1] ?? '';

function uplotAxis(axis, side, which) {
  const ticks = axis.ticks ?? [];
  const within = (u) => ticks.filter(({ at }) => at >= u.scales[which].min && at <= u.scales[which].max);
  const steps = { 1: 1, 2: 2, 5: 5 };
  /** The words at `splits` of these ticks, the important first: those that would touch earlier ones are left out. */
  const wordsApart = (u, splits, important) => {
    const taken = [];
    const shown = new Map();
    for (const { at, words } of important) {
      const place = u.valToPos(at, which, true);
      const half = (which === 'x' ? words.length * 3.4 + 4 : 8) * devicePixelRatio;
      if (taken.some(([middle, other]) => Math.abs(middle - place) < half + other) || (which === 'x' ? u.bbox.width : u.bbox.height) === 0) continue;
      taken.push([place, half]);
      shown.set(at, words);
    }
    return splits.map((at) => shown.get(at) ?? '');
  };
  return {
    scale: which, side, stroke: () => palette.quiet, font: '11px system-ui, sans-serif',
    label: side === 0 ? undefined : axis.label || undefined, labelFont: '12px system-ui, sans-serif', labelSize: 18, labelGap: 2,
    size: side === 3 ? 46 : side === 0 ? 20 : 26, gap: 4,
    grid: { show: side !== 0, stroke: () => palette.line, width: 0.6 },
    ticks: { stroke: () => palette.line, width: 1, size: 4 },
    ...(ticks.length ? {
      splits: (u) => within(u).map(({ at }) => at).sort((a, b) => a - b),
      values: (u, splits) => wordsApart(u, splits, within(u)),
    } : axis.numbers === false ? { values: (u, splits) => splits.map(() => '') }
      : axis.logarithmic ? {
        splits: (u) => {
          const out = [];
          for (let power = Math.floor(Math.log10(u.scales[which].min)); power <= Math.ceil(Math.log10(u.scales[which].max)); ++power) {
            for (const step of Object.values(steps)) {
              const at = Number(`${step}e${power}`);
              if (at >= u.scales[which].min && at <= u.scales[which].max) out.push(at);
            }
          }
          return out;
        },
        filter: (u, splits) => splits, // uPlot's own leaves the decades
        values: (u, splits) => wordsApart(u, splits, [true, false].flatMap((decade) => splits
          .filter((at) => at.toExponential().startsWith('1') === decade).map((at) => ({ at, words: String(at) })))),
      } : { values: (u, splits) => splits.map((at) => String(Number(at.toPrecision(6))).replace('-', '\u2212')) }),
  };
}

/** A panel on the page. `ghost` is the same panel of the pinned design, drawn pale beneath. */
class DrawnPanel {
  constructor(panel, height, toScale, heading) {
    this.height = height;
    this.toScale = toScale;
    this.titleWords = el('span');
    this.top = el('span', { class: 'top' });
    this.title = el(heading, {}, this.titleWords, this.top);
    this.holder = el('div', { class: 'canvas', tabindex: '0', role: 'group' });
    this.legend = el('ul', { class: 'legend' });
    this.at = el('span', { class: 'at' }, '');
    this.node = el('div', { class: 'panel' }, this.title, this.holder, this.legend);
    this.holder.addEventListener('keydown', (event) => this.key(event));
    this.set(panel, null);
  }

  set(panel, ghost) {
    const key = JSON.stringify([Boolean(panel.title), panel.x.label, panel.y.label, panel.x.logarithmic, panel.y.logarithmic, panel.top?.label,
      panel.x.numbers, panel.y.numbers, Boolean(panel.top), Boolean(panel.x.ticks?.length), Boolean(panel.y.ticks?.length)]);
    this.panel = panel;
    this.ghost = ghost;
    setText(this.titleWords, panel.title || panel.y.label);
    setText(this.top, panel.top?.label ? `top: ${panel.top.label}` : panel.remark ?? '');
    this.holder.setAttribute('aria-label', `${panel.title || panel.y.label}, over ${panel.x.label}. Arrow keys read the curves; the values are in the table below.`);
    this.setLegend();
    if (key !== this.key_ || !this.plot) {
      this.key_ = key;
      this.plot?.destroy();
      this.plot = null;
      this.draw();
    } else this.update();
  }

  update() {
    const { x, y } = this.ranges();
    const plot = this.plot;
    plot.batch(() => {
      plot.setScale('x', { min: x.lo, max: x.hi });
      plot.setScale('y', { min: y.lo, max: y.hi });
      plot.redraw(false, true);
    });
  }

  /** What both designs need, so that the pinned one stays in sight. */
  ranges() {
    const { x, y } = this.panel;
    if (this.toScale) {
      // One scale for both axes: what would be stretched is widened around its middle.
      const [width, height] = [Math.max(50, this.holder.clientWidth - 66), this.height - 58];
      const perPixel = Math.max((x.range.hi - x.range.lo) / width, (y.range.hi - y.range.lo) / height);
      const widened = ({ lo, hi }, pixels) => ({ lo: (lo + hi - perPixel * pixels) / 2, hi: (lo + hi + perPixel * pixels) / 2 });
      return { x: widened(x.range, width), y: widened(y.range, height) };
    }
    if (!this.ghost || this.ghost.x.logarithmic !== x.logarithmic) return { x: x.range, y: y.range };
    const both = (a, b) => ({ lo: Math.min(a.lo, b.lo), hi: Math.max(a.hi, b.hi) });
    return { x: both(x.range, this.ghost.x.range), y: both(y.range, this.ghost.y.range) };
  }

  draw() {
    const width = this.holder.clientWidth;
    if (!width) return; // hidden; `resize` comes when it is not
    const { panel } = this;
    const axes = [uplotAxis(panel.x, 2, 'x'), uplotAxis(panel.title ? panel.y : { ...panel.y, label: '' }, 3, 'y')];
    // The ticks of the upper edge are those of the panel at hand, which changes while a slider moves.
    axes[0].label = panel.x.label;
    if (panel.top) axes.push(uplotAxis({ get ticks() { return []; }, ...panel.top, label: panel.top.label }, 0, 'x'));
    const range = (which) => () => { const { lo, hi } = this.ranges()[which]; return [lo, hi]; };
    const { x, y } = this.ranges();
    this.plot = new uPlot({
      width, height: this.height, legend: { show: false }, padding: [panel.top ? 0 : 8, 10, 0, 0],
      scales: { x: { time: false, distr: panel.x.logarithmic ? 3 : 1, range: range('x') },
        y: { distr: panel.y.logarithmic ? 3 : 1, range: range('y') } },
      axes: axes.map((axis, i) => this.live(axis, i)),
      series: [{}, { show: true, points: { show: false } }],
      cursor: { drag: { x: false, y: false }, y: false, points: { show: false },
        sync: { key: panel.x.label, scales: ['x', null] } },
      hooks: { draw: [(u) => this.paint(u)], setCursor: [(u) => this.read(u)] },
    }, [[x.lo, x.hi], [y.lo, y.hi]].map((ends, i) => (i ? [null, null] : ends)), this.holder);
  }

  /** Given ticks are looked up when drawn: they move with the design. */
  live(axis, index) {
    const of = () => (index === 0 ? this.panel.x : index === 1 ? this.panel.y : this.panel.top);
    if (!(of().ticks?.length)) return axis;
    const fresh = () => uplotAxis(of(), axis.side, axis.scale);
    return { ...axis, splits: (u) => fresh().splits?.(u) ?? [], values: (u, splits) => fresh().values(u, splits) };
  }

  resize() {
    const width = this.holder.clientWidth;
    if (!width) return;
    if (this.plot) {
      if (width !== this.plot.width) this.plot.setSize({ width, height: this.height });
    } else this.draw();
  }

  recolour() {
    this.plot?.redraw(false, true);
  }

  paint(u) {
    const { ctx } = u;
    const labels = [];
    const layers = (panel, alpha) => {
      for (const layer of panel.layers) {
        ctx.save();
        ctx.beginPath();
        ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
        ctx.clip();
        ctx.globalAlpha = alpha;
        painters[layer.kind]?.(ctx, u, layer, panel, labels);
        ctx.restore();
      }
    };
    if (this.ghost) layers({ ...this.ghost, layers: this.ghost.layers.filter(({ kind }) => kind === 'curve' || kind === 'points') }, 0.28);
    layers(this.panel, 1);
    ctx.save();
    ctx.strokeStyle = palette.line;
    ctx.lineWidth = devicePixelRatio;
    ctx.strokeRect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    ctx.restore();
  }

  setLegend() {
    const named = this.panel.layers.filter((layer) => layer.words && layer.kind !== 'note' && layer.kind !== 'reference');
    const key = JSON.stringify(named.map(({ kind, words, colour: name, dash, mark, cells }) => [kind, words, name, dash, mark, cells]));
    this.named = named;
    if (key === this.legendKey) return;
    this.legendKey = key;
    this.readings = named.map(() => el('output', { class: 'reading' }));
    this.legend.replaceChildren(...named.map((layer, i) =>
      el('li', {}, sample(layer), el('span', {}, [layer.words, ...(layer.cells ?? [])].join(' · ')), this.readings[i])),
    ...(this.panel.key ?? []).map((words) => el('li', {}, words)), el('li', { class: 'at-item' }, this.at));
  }

  read(u) {
    const { left } = u.cursor;
    const at = left >= 0 ? u.posToVal(left, 'x') : null;
    setText(this.at, finite(at) ? `at ${shown(at)} ${unitOf(this.panel.x)}` : '');
    this.named.forEach((layer, i) => {
      const height = finite(at) && layer.kind === 'curve' ? heightAt(layer, at) : null;
      setText(this.readings[i], finite(height) ? `${shown(height)} ${unitOf(this.panel.y)}` : '');
    });
  }

  key(event) {
    const step = { ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10 }[event.key];
    if (!step || !this.plot) return;
    event.preventDefault();
    const width = this.plot.over.clientWidth;
    const before = this.plot.cursor.left >= 0 ? this.plot.cursor.left : width / 2;
    this.plot.setCursor({ left: Math.min(width, Math.max(0, before + step * width / 100)), top: 10 });
  }
}

/** The curves and points of a panel as rows, for those who cannot see them. */
function panelTable(panel) {
  const named = panel.layers.filter((layer) => (layer.kind === 'curve' || layer.kind === 'points') && layer.x.length);
  const title = panel.title || panel.y.label;
  return named.map((layer) => {
    const name = layer.words || layer.label || 'a line';
    const stride = Math.ceil(layer.x.length / 60); // as many rows as a reader may want
    const rows = [];
    for (let i = 0; i < layer.x.length; i += stride) rows.push([shown(layer.x[i]), shown(layer.y[i])]);
    return el('div', { class: 'values' }, el('p', {}, `${title}: ${name}`), table(`${title}: ${name}`, [panel.x.label, panel.y.label], rows));
  });
}

/** A figure on the page, which follows its data: `show(figure, pinned)` as often as wanted. */
export class DrawnFigure {
  constructor({ height = 250, heading = 'h3', unseen = false } = {}) {
    this.height = height;
    this.below = `h${Number(heading[1]) + 1}`; // headings of its parts
    this.heading = el(heading, { class: unseen ? 'unseen' : null });
    this.panels = [];
    this.place = el('div', { class: 'panels' });
    this.rest = el('div', { class: 'rest' });
    this.values = el('details', { class: 'as-table', ontoggle: () => this.fillTable() }, el('summary', {}, 'Values as a table'));
    this.description = el('p', { class: 'unseen' });
    this.node = el('figure', {}, this.heading, this.description, this.place, this.rest, this.values);
    new ResizeObserver(() => this.resize()).observe(this.node);
  }

  show(figure, pinned = null) {
    this.figure = figure;
    setText(this.heading, figure.heading);
    setText(this.description, figure.description ?? '');
    const panels = figure.parts.filter(({ kind }) => kind === 'panel');
    const pinnedPanels = pinned?.parts.filter(({ kind }) => kind === 'panel') ?? [];
    while (this.panels.length > panels.length) this.panels.pop().node.remove();
    panels.forEach((panel, i) => {
      const ghost = pinnedPanels[i] ?? null;
      if (!this.panels[i]) {
        this.panels.push(new DrawnPanel(panel, figure.toScale ? this.height * 1.5 : this.height, figure.toScale, this.below));
        this.place.append(this.panels[i].node);
      }
      this.panels[i].set(panel, ghost);
    });
    const others = figure.parts.filter(({ kind }) => kind !== 'panel');
    this.rest.replaceChildren(...others.map((part) => el('div', {}, part.title ? el(this.below, {}, part.title) : null,
      part.kind === 'bars' ? el('ul', { class: 'bars' }, part.bars.map((bar) => el('li', {},
        el('span', {}, bar.words), el('meter', { min: 0, max: 1, value: Math.min(1, Math.max(0, bar.share)), 'aria-label': bar.words }), el('span', { class: 'n' }, bar.number))))
        : el('ul', {}, part.texts.map((text) => el('li', {}, text))))));
    if (this.values.open) this.fillTable();
  }

  fillTable() {
    if (!this.values.open || !this.figure) return;
    this.values.replaceChildren(this.values.firstChild,
      el('div', { class: 'value-tables' }, this.figure.parts.filter(({ kind }) => kind === 'panel').flatMap(panelTable)));
  }

  resize() { for (const panel of this.panels) panel.resize(); }
  recolour() { for (const panel of this.panels) panel.recolour(); }
}
