"use strict";
(() => {
  const source = document.getElementById("explorer-data");
  const host = document.getElementById("explorer");
  if (!source || !host) return;
  const { cycles, names, colours, statuses, letters } = JSON.parse(source.textContent);
  const SIDE = 400;
  const COLOURS = { path: "#7b3294", push: "#0072b2", pull: "#c0281c", unknown: "#777777", in: "#009e73", out: "#cc79a7", other: "#e69f00" };
  const state = { cycle: 0, loop: 0, k: 0, avalanche: -1, smallest: 2, layer: "pressure", absorbed: true, timer: 0, hidden: new Set() };


  // Elements.
  const html = (name, attributes = {}, ...children) => {
    const element = document.createElement(name);
    for (const key in attributes) element.setAttribute(key, attributes[key]);
    element.append(...children);
    return element;
  };
  const svg = (name, attributes = {}, text = "") => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const key in attributes) element.setAttribute(key, attributes[key]);
    element.textContent = text;
    return element;
  };
  const button = (id, text, label, act) => {
    const element = html("button", { type: "button", id: "explorer-" + id, "aria-label": label, title: label }, text);
    element.addEventListener("click", act);
    return element;
  };
  const choice = (id, label, act) => {
    const select = html("select", { id: "explorer-" + id });
    select.addEventListener("change", () => act(select.value));
    const named = rich(html("label"), label + " ");
    named.append(select);
    return [select, named];
  };
  const number = (value, digits = 3) => {
    if (value === 0) return "0";
    const small = Math.abs(value) < 1e-3 || Math.abs(value) >= 1e5;
    const [head, power] = (small ? value.toExponential(digits - 1) : String(Number(value.toPrecision(digits)))).split("e");
    const raised = power && power.replace("+", "").replace(/./g, (c) => ({ "-": "⁻" })[c] || "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]);
    return head.replace("-", "−") + (power ? " × 10" + raised : "");
  };
  // A value in the first of some units that it reaches, or in the last.
  const scaled = (value, units) => {
    const [unit, scale] = units.find((of) => Math.abs(value) >= of[1]) || units[units.length - 1];
    return number(value / scale) + " " + unit;
  };
  const length = (metres) => scaled(metres, [["mm", 1e-3], ["µm", 1e-6], ["nm", 1e-9]]);
  const pascal = (value) => scaled(value, [["GPa", 1e9], ["MPa", 1e6], ["kPa", 1e3], ["Pa", 1]]);
  const PREFIXES = [["", 1], ["m", 1e-3], ["µ", 1e-6], ["n", 1e-9], ["p", 1e-12], ["f", 1e-15]];
  const prefix = (most) => PREFIXES.find((of) => most >= of[1]) || PREFIXES[PREFIXES.length - 1];
  const metric = (value, unit) => (value ? scaled(value, PREFIXES.map(([letter, scale]) => [letter + unit, scale])) : "0 " + unit);
  // Text with the subscripts of symbols, in HTML and in drawings.
  const parts = (text) => text.split(/_(rms|max)/);
  const rich = (element, text) => (element.replaceChildren(...parts(text).map((part, n) => (n % 2 ? html("sub", {}, part) : part))), element);
  const drawn = (element, text) => {
    const pieces = parts(text).map((part, n) => svg("tspan", n % 2 ? { dy: 4, "font-size": "75%" } : n ? { dy: -4 } : {}, part));
    element.replaceChildren(...pieces);
    return element;
  };

  // Contact sets of all steps of a loop, from the status of spots after events; stored steps are taken as they are.
  const contacts = (cycle, loop) => {
    const [inside, absorbed, sets] = [new Set(), new Set(), []];
    let at = 0;
    for (let k = 0; k < loop.f.length; k++) {
      for (; at < loop.events.length && loop.events[at][0] <= k; at++) {
        const [spot, status] = [loop.events[at][2], statuses[loop.events[at][5]]];
        const parts = (cycle.merged || {})[spot] || [];
        for (const of of [spot, ...parts]) inside.delete(of);
        absorbed.delete(spot);
        if (status === "contact") inside.add(spot);
        if (status === "covered") absorbed.add(spot);
        if (status === "split") parts.forEach((part) => inside.add(part));
      }
      const frame = loop.frames[k];
      if (frame) {
        inside.clear();
        for (let n = 0; n < frame.length; n += 2) inside.add(frame[n]);
      }
      sets.push([Array.from(inside), Array.from(absorbed)]);
    }
    return sets;
  };

  // Radii over L and signs of the contacts at a step: stored, or interpolated and scaled to the contact area.
  const prepare = (cycle, loop) => {
    if (loop.sets) return;
    loop.sets = cycle.x ? contacts(cycle, loop) : loop.f.map(() => [[], []]);
    loop.known = new Map();
    for (const k of Object.keys(loop.frames || {}).map(Number).sort((a, b) => a - b)) {
      const frame = loop.frames[k];
      for (let n = 0; n < frame.length; n += 2) {
        const list = loop.known.get(frame[n]) || loop.known.set(frame[n], []).get(frame[n]);
        list.push([k, frame[n + 1] * 1e-5]);
      }
    }
  };
  const radii = (loop, k) => {
    const [inside] = loop.sets[k];
    const spare = 0.5 * Math.sqrt(Math.max(loop.a[k], 1e-12) / (Math.PI * Math.max(1, inside.length)));
    const found = inside.map((spot) => {
      const list = loop.known.get(spot) || [];
      const before = list.filter((of) => of[0] <= k).pop();
      const after = list.find((of) => of[0] >= k);
      if (!before && !after) return [spot, spare, 0];
      const [u, v] = [before || after, after || before];
      const share = v[0] > u[0] ? (k - u[0]) / (v[0] - u[0]) : 0;
      const r = Math.sqrt((1 - share) * u[1] * u[1] + share * v[1] * v[1]);
      return [spot, r, Math.sign(share < 0.5 ? u[1] : v[1])];
    });
    if (loop.frames[k]) return found;
    const sum = found.reduce((all, of) => all + Math.PI * of[1] * of[1], 0);
    const scale = sum > 0 ? Math.min(2, Math.max(0.4, Math.sqrt(loop.a[k] / sum))) : 1;
    return found.map(([spot, r, sign]) => [spot, r * scale, sign]);
  };

  // Pictures of heights, pressures and gaps, from one letter for each cell.
  const picture = (text, colour) => {
    const cells = Math.round(Math.sqrt(text.length));
    const canvas = html("canvas", { width: cells, height: cells });
    const context = canvas.getContext("2d");
    const image = context.createImageData(cells, cells);
    for (let i = 0; i < cells; i++) {
      for (let j = 0; j < cells; j++) {
        image.data.set([...colour(letters.indexOf(text[i * cells + j])), 255], 4 * ((cells - 1 - j) * cells + i));
      }
    }
    context.putImageData(image, 0, 0);
    return canvas.toDataURL();
  };
  const grey = (level) => Array(3).fill(150 + Math.round((105 * level) / 63));
  const mix = (from, to, share) => from.map((part, n) => Math.round(part + share * (to[n] - part)));
  const pressure = (level) =>
    level > 32 ? mix([225, 235, 245], [0, 60, 110], (level - 32) / 31) : level < 32 ? mix([252, 232, 215], [160, 20, 15], (32 - level) / 32) : [255, 255, 255];

  // Zoom by the view box: buttons, drag, wheel with Ctrl.
  const zoomable = (drawing, side) => {
    const box = { x: 0, y: 0, w: side };
    drawing.view = box;
    const apply = () => {
      drawing.setAttribute("viewBox", `${box.x} ${box.y} ${box.w} ${box.w}`);
      const old = drawing.querySelector(".bar");
      if (old) old.replaceWith(bar(drawing));
    };
    const zoom = (factor, at = [0.5, 0.5]) => {
      const w = Math.min(side, Math.max(side / 16, box.w * factor));
      box.x = Math.min(side - w, Math.max(0, box.x + at[0] * (box.w - w)));
      box.y = Math.min(side - w, Math.max(0, box.y + at[1] * (box.w - w)));
      box.w = w;
      apply();
    };
    let from = null;
    drawing.addEventListener("pointerdown", (event) => (from = [event.clientX, event.clientY]));
    drawing.addEventListener("pointermove", (event) => {
      if (!from || box.w === side) return;
      const unit = box.w / drawing.clientWidth;
      box.x = Math.min(side - box.w, Math.max(0, box.x - (event.clientX - from[0]) * unit));
      box.y = Math.min(side - box.w, Math.max(0, box.y - (event.clientY - from[1]) * unit));
      from = [event.clientX, event.clientY];
      apply();
    });
    for (const end of ["pointerup", "pointerleave"]) drawing.addEventListener(end, () => (from = null));
    drawing.addEventListener("wheel", (event) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      const place = drawing.getBoundingClientRect();
      zoom(event.deltaY > 0 ? 1.25 : 0.8, [(event.clientX - place.left) / place.width, (event.clientY - place.top) / place.height]);
    });
    return zoom;
  };

  // The page.
  const [cycleChoice, cycleLabel] = choice("cycle", "Cycle", (value) => {
    const load = loop().load;
    choose(Number(value), Math.max(0, cycles[value].loops.findIndex((of) => of.load === load)));
  });
  const [loopChoice, loopLabel] = choice("load", "F_max", (value) => choose(state.cycle, Number(value)));
  const [smallestChoice, smallestLabel] = choice("smallest", "avalanches of at least", (value) => (state.smallest = Number(value)));
  const [layerChoice, layerLabel] = choice("layer", "Boundary elements", (value) => { state.layer = value; draw(); });
  for (const [value, text] of [[1, "1 event"], [2, "2 events"], [5, "5 events"], [10, "10 events"]]) smallestChoice.append(html("option", { value }, text));
  smallestChoice.value = "2";
  for (const value of ["pressure", "gap"]) layerChoice.append(html("option", { value }, value));
  cycles.forEach((cycle, at) => cycleChoice.append(html("option", { value: at }, cycle.name)));
  const slider = html("input", { type: "range", min: 0, max: 1, value: 0, id: "explorer-step", "aria-label": "Position along the loop" });
  const absorbedBox = html("input", { type: "checkbox", id: "explorer-absorbed", checked: "" });
  const absorbedLabel = html("label", {}, absorbedBox, " absorbed asperities");
  const readout = html("p", { id: "explorer-readout", "aria-live": "polite" });
  const chart = svg("svg", { viewBox: "0 0 420 400", role: "img", "aria-label": "Normal force against mean penetration", id: "explorer-chart" });
  const map = svg("svg", { viewBox: `0 0 ${SIDE} ${SIDE}`, role: "img", "aria-label": "Contact map of the asperity model", id: "explorer-map" });
  const field = svg("svg", { viewBox: `0 0 ${SIDE} ${SIDE}`, role: "img", "aria-label": "Map of boundary elements", id: "explorer-field" });
  const zooms = [zoomable(map, SIDE), zoomable(field, SIDE)];
  const zoom = (factor) => zooms.forEach((of) => of(factor));
  const chartNote = html("figcaption");
  const mapNote = html("figcaption", { id: "explorer-map-note" });
  const fieldNote = html("figcaption", { id: "explorer-field-note" });
  const mapFigure = html("figure", {}, map, mapNote);
  const fieldFigure = html("figure", {}, field, fieldNote);
  const play = button("play", "Play", "Play or stop", () => {
    if (state.timer) return stop();
    if (state.k === loop().f.length - 1) move(0);
    play.textContent = "Stop";
    state.timer = setInterval(() => (state.k < loop().f.length - 1 ? move(state.k + 1) : stop()), 100);
  });
  const stop = () => {
    clearInterval(state.timer);
    state.timer = 0;
    play.textContent = "Play";
  };
  const swatch = (colour, text) => {
    const toggle = html("button", { type: "button", "aria-pressed": "true" }, html("i", { style: "background:" + colour }), text);
    toggle.addEventListener("click", () => {
      state.hidden.has(colour) ? state.hidden.delete(colour) : state.hidden.add(colour);
      toggle.setAttribute("aria-pressed", String(!state.hidden.has(colour)));
      draw();
    });
    return html("li", {}, toggle);
  };
  const legend = html("ul", { class: "legend" }, swatch(COLOURS.push, "compressive"), swatch(COLOURS.pull, "tensile"), swatch(COLOURS.unknown, "load not stored"),
    ...["in", "out", "other"].map((colour) => swatch(COLOURS[colour], names.filter((_, kind) => colours[kind] === colour).join(", "))));
  host.append(
    html("p", { class: "controls" }, cycleLabel, loopLabel),
    html("p", { class: "controls" }, button("back", "◀", "Previous step", () => move(state.k - 1)), slider, button("next", "▶", "Next step", () => move(state.k + 1)), play),
    html("p", { class: "controls" }, button("previous-avalanche", "◀ avalanche", "Previous avalanche", () => avalanche(-1)), button("next-avalanche", "avalanche ▶", "Next avalanche", () => avalanche(1)), smallestLabel, absorbedLabel,
      button("in", "+", "Zoom in", () => zoom(0.6)), button("out", "−", "Zoom out", () => zoom(1 / 0.6)), layerLabel),
    readout,
    html("div", { class: "views" }, html("figure", {}, chart, chartNote), mapFigure, fieldFigure),
    legend,
  );
  slider.addEventListener("input", () => move(Number(slider.value)));
  absorbedBox.addEventListener("change", () => { state.absorbed = absorbedBox.checked; draw(); });
  const cycle = () => cycles[state.cycle];
  // Load, penetration and energy: of a probe in their units.
  const force = (value) => (cycle().probe ? "F = " + metric(value * cycle().probe.unit_n, "N") : "F/(E*A₀) = " + number(value));
  const depth = (value) => (cycle().probe ? "Δ = " + metric(value * cycle().probe.unit_m, "m") : "Δ/h_rms = " + number(value));
  const dissipated = (value) => (cycle().probe ? "dissipated energy " + metric(value * cycle().probe.unit_n * cycle().probe.unit_m, "J") : "dissipated energy/(E*A₀h_rms) = " + number(value));
  const loop = () => cycle().loops[state.loop];
  const partner = () => (cycle().other === undefined ? undefined : cycles[cycle().other]);
  const partnerLoop = () => partner() && partner().loops.find((of) => of.load === loop().load);
  // The loop of boundary elements with stored maps.
  const elementsLoop = () => [cycle().x ? partnerLoop() : loop()].find((of) => of && of.maps && of.maps.length);

  // Chart.
  const frame = { left: 58, top: 12, width: 350, height: 330 };
  let axes = null;
  const ticks = (low, high) => {
    const power = 10 ** Math.floor(Math.log10((high - low) / 4));
    const step = [1, 2, 5, 10].map((n) => n * power).find((n) => n >= (high - low) / 5);
    return Array.from({ length: 12 }, (_, n) => (Math.ceil(low / step) + n) * step).filter((value) => value <= high * (1 + 1e-9) || value <= high);
  };
  const path = (of, from, to) => of.f.slice(from, to).map((f, n) => (n ? "L" : "M") + axes.x(of.d[from + n]).toFixed(1) + " " + axes.y(f).toFixed(1)).join("");
  const paint = () => {
    const loops = [loop(), partnerLoop()].filter(Boolean);
    const ends = (values) => {
      const [low, high] = [Math.min(...values), Math.max(...values)];
      return [low - 0.04 * (high - low || 1), high + 0.04 * (high - low || 1)];
    };
    const [x, y] = [ends(loops.flatMap((of) => of.d)), ends(loops.flatMap((of) => of.f))];
    axes = {
      x: (value) => frame.left + (frame.width * (value - x[0])) / (x[1] - x[0]),
      y: (value) => frame.top + (frame.height * (y[1] - value)) / (y[1] - y[0]),
    };
    const foot = frame.top + frame.height;
    chart.replaceChildren(svg("rect", { width: 420, height: 400, fill: "white" }), svg("rect", { x: frame.left, y: frame.top, width: frame.width, height: frame.height, fill: "none", stroke: "black" }));
    // Units of the axes: those of a probe with a prefix, else a power of ten of the load.
    const most = (of) => Math.max(Math.abs(of[0]), Math.abs(of[1]));
    const unit = cycle().probe;
    const [[xLetter, xScale], [yLetter, yScale]] = unit ? [prefix(most(x) * unit.unit_m), prefix(most(y) * unit.unit_n)] : [["", 1], ["", 1]];
    const power = Math.floor(Math.log10(most(y)));
    const [xUnit, yUnit] = unit ? [xScale / unit.unit_m, yScale / unit.unit_n] : [1, 10 ** power];
    for (const value of ticks(x[0] / xUnit, x[1] / xUnit)) chart.append(svg("path", { d: `M${axes.x(value * xUnit)} ${foot}v5`, stroke: "black" }), svg("text", { x: axes.x(value * xUnit), y: foot + 19, "text-anchor": "middle", "font-size": 13 }, number(value)));
    for (const value of ticks(y[0] / yUnit, y[1] / yUnit)) chart.append(svg("path", { d: `M${frame.left} ${axes.y(value * yUnit)}h-5`, stroke: "black" }), svg("text", { x: frame.left - 8, y: axes.y(value * yUnit) + 4.5, "text-anchor": "end", "font-size": 13 }, number(value)));
    const label = svg("text", { transform: `translate(18 ${frame.top + frame.height / 2}) rotate(-90)`, "text-anchor": "middle", "font-size": 15 }, unit ? `F [${yLetter}N]` : "F/(E*A₀)");
    if (!unit) label.append(svg("tspan", {}, "  [10"), svg("tspan", { dy: -5, "font-size": 11 }, String(power).replace("-", "−")), svg("tspan", { dy: 5 }, "]"));
    chart.append(label, drawn(svg("text", { x: frame.left + frame.width / 2, y: 388, "text-anchor": "middle", "font-size": 15 }), unit ? `Δ [${xLetter}m]` : "Δ/h_rms"));
    const [grey, ring] = [partnerLoop() ? "; grey: the other method on this surface" : "", elementsLoop() ? ". Ring: stored map of boundary elements" : ""];
    chartNote.textContent = `Loop: loading dashed, unloading solid${grey}${ring}. A click moves to the nearest step.`;
    for (const of of loops.slice().reverse()) {
      const colour = of === loop() ? COLOURS.path : "#999999";
      chart.append(svg("path", { d: path(of, 0, of.up), fill: "none", stroke: colour, "stroke-width": 2, "stroke-dasharray": "7 4" }));
      chart.append(svg("path", { d: path(of, of.up - 1, of.f.length), fill: "none", stroke: colour, "stroke-width": 2 }));
    }
    chart.append(svg("text", { id: "explorer-tip", x: frame.left + 8, y: frame.top + 18, "font-size": 13 }));
    chart.append(svg("circle", { id: "explorer-map-dot", r: 0, fill: "none", stroke: "black", "stroke-width": 2 }));
    chart.append(svg("circle", { id: "explorer-dot", r: 6, fill: COLOURS.path, stroke: "white" }));
  };
  const nearest = (event) => {
    const place = chart.getBoundingClientRect();
    const [x, y] = [((event.clientX - place.left) * 420) / place.width, ((event.clientY - place.top) * 400) / place.height];
    const far = (k) => Math.hypot(axes.x(loop().d[k]) - x, axes.y(loop().f[k]) - y);
    return loop().f.reduce((best, _, k) => (far(k) < far(best) ? k : best), 0);
  };
  chart.addEventListener("click", (event) => move(nearest(event)));
  chart.addEventListener("pointermove", (event) => {
    const k = nearest(event);
    const tip = document.getElementById("explorer-tip");
    drawn(tip, `step ${loop().s[k]}: ${depth(loop().d[k])}, ${force(loop().f[k])}`);
  });

  // Maps.
  const images = (x, y, r) => {
    if (!cycle().periodic) return [[x, y]];
    const shifts = [-SIDE, 0, SIDE];
    return shifts.flatMap((dx) => shifts.map((dy) => [x + dx, y + dy])).filter(([u, v]) => u > -r && u < SIDE + r && v > -r && v < SIDE + r);
  };
  const at = (spot) => [(cycle().x[spot] * SIDE) / 1e4, SIDE - (cycle().y[spot] * SIDE) / 1e4];
  const current = () => loop().events.filter((event) => (state.avalanche < 0 ? event[0] === state.k : event[3] === state.avalanche));
  const bar = (drawing) => {
    const box = drawing.view;
    const side = (cycle().length_m * box.w) / SIDE;
    const power = 10 ** Math.floor(Math.log10(side / 4));
    const size = [5, 2, 1].map((n) => n * power).find((n) => n <= (side / 4) * (1 + 1e-9));
    const width = (SIDE * size) / side;
    const group = svg("g", { class: "bar", transform: `translate(${box.x} ${box.y}) scale(${box.w / SIDE})` });
    group.append(svg("rect", { x: 6, y: SIDE - 34, width: width + 12, height: 28, fill: "white", "fill-opacity": 0.85 }), svg("rect", { x: 12, y: SIDE - 14, width, height: 3 }), svg("text", { x: 12, y: SIDE - 19, "font-size": 13 }, length(size)));
    return group;
  };
  const drawSpots = () => {
    const of = cycle();
    map.replaceChildren();
    if (!of.image) of.image = picture(of.ground, grey);
    map.append(svg("image", { href: of.image, width: SIDE, height: SIDE, preserveAspectRatio: "none" }));
    const spots = svg("g", { id: "explorer-spots", "fill-opacity": 0.85 });
    let count = 0;
    const sizes = new Map();
    for (const [spot, r, sign] of radii(loop(), state.k)) {
      count += 1;
      sizes.set(spot, r);
      const [x, y] = at(spot);
      const fill = sign > 0 ? COLOURS.push : sign < 0 ? COLOURS.pull : COLOURS.unknown;
      if (state.hidden.has(fill)) continue;
      images(x, y, r * SIDE).forEach(([u, v], copy) => {
        const circle = svg("circle", { cx: u.toFixed(2), cy: v.toFixed(2), r: (r * SIDE).toFixed(2), fill });
        if (!copy) circle.setAttribute("data-spot", of.ids[spot]);
        circle.append(svg("title", {}, `asperity ${of.ids[spot]}: contact radius ${length(r * of.length_m)}, ${sign > 0 ? "compressive" : sign < 0 ? "tensile" : "load not stored"}`));
        spots.append(circle);
      });
    }
    map.append(spots);
    const absorbed = state.absorbed ? loop().sets[state.k][1] : [];
    map.append(svg("path", { id: "explorer-absorbed-marks", stroke: "black", "stroke-width": 1, d: absorbed.map((spot) => at(spot)).map(([x, y]) => `M${x - 2.5} ${y - 2.5}l5 5m0 -5l-5 5`).join("") }));
    const lit = svg("g", { id: "explorer-events", fill: "none", "stroke-width": 3 });
    for (const [, kind, spot] of current()) {
      if (spot < 0) continue;
      const [x, y] = at(spot);
      const colour = COLOURS[colours[kind]];
      if (!state.hidden.has(colour)) lit.append(svg("circle", { cx: x.toFixed(2), cy: y.toFixed(2), r: ((sizes.get(spot) || 0.006) * SIDE + 4).toFixed(2), stroke: colour, "data-event": of.ids[spot] }));
    }
    map.append(lit, bar(map));
    const exact = loop().frames[state.k];
    mapNote.textContent = `Asperity model: ${count} contact spots, ${absorbed.length} absorbed. ` +
      (exact ? "Stored step: radii and loads from the table contacts." : "Between stored steps: contacts from the events, radii interpolated and scaled to the contact area.");
  };
  const drawField = (of, other, nearest) => {
    const stored = (other.maps || []).filter((one) => one.k >= 0);
    field.replaceChildren();
    const best = stored.reduce((best, one) => (best === null || nearest(one) < nearest(best) ? one : best), null);
    if (!best) return (fieldNote.textContent = "Boundary elements: no stored map.");
    const key = state.layer + "_image";
    if (!best[key]) best[key] = picture(best[state.layer], state.layer === "gap" ? grey : pressure);
    field.append(svg("image", { id: "explorer-field-image", style: "image-rendering:pixelated", href: best[key], width: SIDE, height: SIDE, preserveAspectRatio: "none", "data-step": other.s[best.k] }), bar(field));
    const dot = document.getElementById("explorer-map-dot");
    for (const [name, value] of [["cx", axes.x(other.d[best.k])], ["cy", axes.y(other.f[best.k])], ["r", 6]]) dot.setAttribute(name, value);
    rich(fieldNote, `Boundary elements, ${best.k < other.up ? "loading" : "unloading"}: nearest stored map, ${depth(other.d[best.k])}, ${force(other.f[best.k])}. ` +
      (state.layer === "gap" ? `Gap from 0 (dark) to ${length(best.gap_m)} (light).` : `Pressure from ${pascal(best.low_pa)} (red) to ${pascal(best.high_pa)} (blue).`));
  };
  const draw = () => {
    const of = loop();
    const dot = document.getElementById("explorer-dot");
    dot.setAttribute("cx", axes.x(of.d[state.k]));
    dot.setAttribute("cy", axes.y(of.f[state.k]));
    slider.value = state.k;
    const branch = state.k < of.up ? "loading" : "unloading";
    slider.setAttribute("aria-valuetext", `step ${of.s[state.k]}, ${branch}`);
    const own = current();
    const counts = new Map();
    own.forEach((event) => counts.set(event[1], (counts.get(event[1]) || 0) + 1));
    const said = Array.from(counts, ([kind, count]) => `${count} × ${names[kind]}`).join(", ");
    const energy = own.reduce((sum, event) => sum + event[4], 0);
    const place = state.avalanche < 0 ? "at this step" : `avalanche ${state.avalanche}`;
    rich(readout, `Step ${of.s[state.k]}, ${branch}: ${force(of.f[state.k])}, ${depth(of.d[state.k])}, A/A₀ = ${number(of.a[state.k])}, ${of.n[state.k]} contact${of.n[state.k] === 1 ? "" : "s"}. ` +
      `Events, ${place}: ${own.length ? said + `; ${dissipated(energy)}` : "none"}.`);
    const field = elementsLoop();
    mapFigure.hidden = !cycle().x;
    fieldFigure.hidden = layerLabel.hidden = !field;
    absorbedLabel.hidden = legend.hidden = !cycle().x;
    if (cycle().x) drawSpots();
    if (field) {
      const up = state.k < of.up;
      drawField(cycle(), field, (one) => Math.abs(field.d[one.k] - of.d[state.k]) + (one.k < field.up === up ? 0 : 1e3));
    }
  };
  const move = (k) => {
    state.k = Math.min(loop().f.length - 1, Math.max(0, k));
    state.avalanche = -1;
    draw();
  };
  const avalanche = (way) => {
    stop();
    const sizes = new Map();
    loop().events.forEach((event) => sizes.set(event[3], (sizes.get(event[3]) || 0) + 1));
    const order = Array.from(sizes.keys()).filter((id) => sizes.get(id) >= state.smallest);
    const first = (id) => loop().events.find((event) => event[3] === id)[0];
    const here = order.indexOf(state.avalanche);
    let next = here + way;
    if (here < 0) next = way > 0 ? order.findIndex((id) => first(id) >= state.k) : order.filter((id) => first(id) < state.k).length - 1;
    if (order[next] === undefined) return;
    state.avalanche = order[next];
    state.k = first(state.avalanche);
    draw();
  };
  const choose = (chosen, which) => {
    stop();
    Object.assign(state, { cycle: chosen, loop: which, avalanche: -1 });
    loopChoice.replaceChildren(...cycle().loops.map((of, n) => html("option", { value: n }, cycle().probe ? metric(of.load * cycle().probe.unit_n, "N") : number(of.load, 4) + " E*A₀")));
    loopChoice.value = which;
    cycleChoice.value = chosen;
    cycle().loops.forEach((of) => prepare(cycle(), of));
    slider.max = loop().f.length - 1;
    state.k = loop().up - 1;
    paint();
    draw();
  };
  choose(0, cycles[0].loops.length - 1);
})();
