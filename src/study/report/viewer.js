// Pictures and maps. Pixels come as base64 of the floats themselves; tone mapping is done here, so exposure and false colour
// work on the values, and the value under the pointer is the file's.
"use strict";
const pixelList = JSON.parse(document.getElementById("pixel-list").textContent);
const pictures = pixelList.filter(p => p.kind === "picture"), maps = pixelList.filter(p => p.kind !== "picture");

function decode(entry) {
  if (entry.values) return entry.values;
  const text = atob(document.getElementById(entry.id).textContent), count = entry.width * entry.height * entry.channels, bytes = entry.bytes;
  const values = new Float32Array(count), bits = new Uint32Array(values.buffer);
  for (let i = 0, k = 0; i < count; ++i, k += bytes) {
    let word = 0;
    for (let b = 0; b < bytes; ++b) word |= text.charCodeAt(k + b) << 8 * b;
    if (bytes === 4) bits[i] = word; else if (bytes === 3) bits[i] = word << 8; else values[i] = fromHalf(word);
  }
  return entry.values = values;
}
function fromHalf(h) {
  const sign = h & 0x8000 ? -1 : 1, exponent = h >> 10 & 31, fraction = h & 1023;
  return exponent === 0 ? sign * fraction * 2 ** -24 : exponent === 31 ? (fraction ? NaN : sign * Infinity) : sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

// sRGB and the colour scales as tables.
const srgb = new Uint8ClampedArray(4097);
for (let i = 0; i <= 4096; ++i) { const v = i / 4096; srgb[i] = Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055)); }
const encode = v => v >= 1 ? 255 : v > 0 ? srgb[Math.round(v * 4096)] : 0;
function table(interpolator) { const t = new Uint8Array(768); for (let i = 0; i < 256; ++i) { const c = d3.rgb(interpolator(i / 255)); t.set([c.r, c.g, c.b], 3 * i); } return t; }
const magma = table(d3.interpolateMagma), signed = table(t => d3.interpolateRdBu(1 - t));
const luminance = (v, i) => 0.2126 * v[i] + 0.7152 * v[i + 1] + 0.0722 * v[i + 2];

const reference = pictures.find(p => p.label === "reference");
let floorOfReference = 0;
function relativeFloor() {
  if (floorOfReference) return floorOfReference;
  const v = decode(reference); let sum = 0, n = 0;
  for (const x of v) if (isFinite(x)) { sum += x; ++n; }
  return floorOfReference = 0.01 * (sum / n) ** 2 || 1e-30;
}
function relativeError(v, i) {
  const r = decode(reference), floor = relativeFloor(); let sum = 0;
  for (let c = 0; c < 3; ++c) sum += (v[i + c] - r[i + c]) ** 2 / (r[i + c] ** 2 + floor);
  return Math.sqrt(sum / 3);
}

// A canvas of the picture's own size in the mode and exposure asked for, kept until one of them changes.
function developed(entry, mode, exposure) {
  const key = mode + exposure;
  if (entry.key === key) return entry.canvas;
  const v = decode(entry), gain = 2 ** exposure, canvas = entry.canvas || (entry.canvas = document.createElement("canvas"));
  canvas.width = entry.width; canvas.height = entry.height;
  const context = canvas.getContext("2d"), image = context.createImageData(entry.width, entry.height), out = image.data;
  for (let i = 0, o = 0; i < v.length; i += 3, o += 4) {
    if (mode === "colour") { out[o] = encode(v[i] * gain); out[o + 1] = encode(v[i + 1] * gain); out[o + 2] = encode(v[i + 2] * gain); }
    else {
      // Luminance over eight stops below white; error on a linear scale to 1.
      const value = mode === "error" ? relativeError(v, i) * gain : 1 + Math.log2(Math.max(luminance(v, i) * gain, 1e-30)) / 8;
      const at = 3 * Math.round(255 * Math.min(1, Math.max(0, value || 0)));
      out[o] = magma[at]; out[o + 1] = magma[at + 1]; out[o + 2] = magma[at + 2];
    }
    out[o + 3] = 255;
  }
  context.putImageData(image, 0, 0);
  entry.key = key;
  return canvas;
}

const view = {split: .5, zoom: 1, x: 0, y: 0, exposure: 0, mode: "colour", left: null, right: null, cursor: null, aimed: false, stripAsked: false};
const canvas = $("canvas"), viewer = $("viewer");
const entryFor = label => pictures.find(p => p.label === label && (label === "reference" || p.budget === +$("budget").value));
const nameOf = e => e.label === "reference" ? "reference" : `${e.label}, ${figure(e.budget)} s`;

// Screen pixels (of the canvas) a picture's pixel takes at zoom 1.
const fit = () => canvas.width / view.left.width;
function draw() {
  if (!view.left) return;
  const context = canvas.getContext("2d"), scale = fit() * view.zoom, edge = Math.round(view.split * canvas.width);
  context.setTransform(1, 0, 0, 1, 0, 0); context.fillStyle = "#000"; context.fillRect(0, 0, canvas.width, canvas.height);
  for (const [entry, from, to] of [[view.left, 0, edge], [view.right, edge, canvas.width]]) {
    context.save(); context.beginPath(); context.rect(from, 0, to - from, canvas.height); context.clip();
    context.imageSmoothingEnabled = scale < 1.5;
    context.setTransform(scale, 0, 0, scale, -view.x * scale, -view.y * scale);
    context.drawImage(developed(entry, view.mode, view.exposure), 0, 0);
    context.restore();
  }
  $("divider").style.left = 100 * view.split + "%"; $("divider").setAttribute("aria-valuenow", Math.round(100 * view.split));
  $("label-left").textContent = nameOf(view.left); $("label-right").textContent = nameOf(view.right);
  if (view.aimed) {  // the pixel that the keyboard reads
    const x = (view.cursor.x - view.x) * scale, y = (view.cursor.y - view.y) * scale, arm = 7 * (window.devicePixelRatio || 1);
    for (const [colour, width] of [["#000", 4], ["#fff", 1.5]]) {
      context.beginPath(); context.moveTo(x - arm, y); context.lineTo(x + arm, y); context.moveTo(x, y - arm); context.lineTo(x, y + arm);
      context.strokeStyle = colour; context.lineWidth = width; context.stroke();
    }
  }
  viewer.style.touchAction = view.zoom > 1 ? "none" : "pan-y";  // a finger scrolls the page until there is something to pan
  if (!view.stripAsked) { view.stripAsked = true; requestAnimationFrame(drawStrip); }
  tellPixel();
}
// The small pictures beside each other: the same cut of each, so zoom and pan move them all.
function drawStrip() {
  view.stripAsked = false;
  d3.select("#strip").selectAll("canvas").each(function () {
    const entry = entryFor(d3.select(this).datum()), context = this.getContext("2d");
    d3.select(this.parentNode).classed("shown", entry === view.left || entry === view.right).style("display", entry ? null : "none");
    if (!entry) return;
    d3.select(this.parentNode).select("span").text(nameOf(entry));
    this.width = 320; this.height = Math.max(1, Math.round(320 * entry.height / entry.width));
    const scale = this.width / entry.width * view.zoom;
    context.imageSmoothingEnabled = scale < 1.5;
    context.setTransform(scale, 0, 0, scale, -view.x * scale, -view.y * scale);
    context.drawImage(developed(entry, view.mode, view.exposure), 0, 0);
  });
}
function resize() {
  if (!view.left) return;
  const width = Math.round(viewer.clientWidth * (window.devicePixelRatio || 1)), height = Math.round(width * view.left.height / view.left.width);
  if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
  draw();
}
function clampView() {
  view.zoom = Math.min(64, Math.max(1, view.zoom));
  view.x = Math.min(Math.max(0, view.x), view.left.width * (1 - 1 / view.zoom)); view.y = Math.min(Math.max(0, view.y), view.left.height * (1 - 1 / view.zoom));
}
function toPicture(event) {
  const box = canvas.getBoundingClientRect();
  return {x: view.x + (event.clientX - box.left) / box.width * view.left.width / view.zoom, y: view.y + (event.clientY - box.top) / box.height * view.left.height / view.zoom};
}
function zoomAt(point, factor) {
  const before = view.zoom; view.zoom = Math.min(64, Math.max(1, view.zoom * factor));
  view.x = point.x - (point.x - view.x) * before / view.zoom; view.y = point.y - (point.y - view.y) * before / view.zoom;
  clampView(); draw();
}
// The keyboard has no pointer: it reads the pixel in the middle of the view.
function aim() { view.aimed = true; view.cursor = {x: view.x + view.left.width / view.zoom / 2, y: view.y + view.left.height / view.zoom / 2}; draw(); }
// Digits that the packing keeps: 7 of float32, 5 with 16 bits of mantissa, 4 of a half.
const digitsOf = entry => ({4: 7, 3: 5, 2: 4})[entry.bytes];
function tellPixel() {
  const p = view.cursor;
  if (!p || p.x < 0 || p.y < 0 || p.x >= view.left.width || p.y >= view.left.height) return;
  const x = Math.floor(p.x), y = Math.floor(p.y), i = 3 * (y * view.left.width + x);
  const line = entry => { const v = decode(entry); return nameOf(entry).padEnd(22) + [0, 1, 2].map(c => figure(v[i + c], digitsOf(entry)).padStart(12)).join("") + (entry === reference ? "" : "   relative error " + figure(relativeError(v, i))); };
  const both = [view.left, view.right].concat([view.left, view.right].includes(reference) ? [] : [reference]);
  $("pixel").textContent = `pixel ${x},${y}\n` + both.map(line).join("\n");
  $("pixel").dataset.values = JSON.stringify({x, y, left: Array.from(decode(view.left).slice(i, i + 3)), right: Array.from(decode(view.right).slice(i, i + 3))});
}
function choose() {
  const budget = $("budget").value;
  view.left = entryFor($("left").value) || reference; view.right = entryFor($("right").value) || reference;
  viewer.setAttribute("aria-label", `${nameOf(view.left)} on the left, ${nameOf(view.right)} on the right, at ${budget} seconds`);
  resize();
}

function startViewer() {
  if (!reference) { $("h-pictures").parentNode.hidden = true; return; }
  const labels = ["reference"].concat(methods.map(m => m.method).filter(l => pictures.some(p => p.label === l)));
  for (const id of ["left", "right"]) d3.select("#" + id).selectAll("option").data(labels).enter().append("option").text(l => l).attr("value", l => l);
  $("left").value = labels[Math.min(1, labels.length - 1)]; $("right").value = labels[labels.length > 2 ? 2 : 0];
  const budgets = [...new Set(pictures.filter(p => p !== reference).map(p => p.budget))];
  d3.select("#budget").selectAll("option").data(budgets).enter().append("option").text(b => figure(b) + " s").attr("value", b => b);
  $("precision").textContent = (reference.halved ? "The pictures are shown at half their size to keep the page small; values are means of 2 × 2 pixels. " : "") +
    ({4: "Values under the pointer are those of the EXR, bit for bit.", 3: "Values under the pointer are those of the EXR to 5 digits.", 2: "Values under the pointer are those of the EXR, rounded to half floats."})[reference.bytes];
  for (const id of ["left", "right", "budget"]) $(id).onchange = choose;
  $("mode").onchange = () => { view.mode = $("mode").value; draw(); };
  $("exposure").oninput = () => { view.exposure = +$("exposure").value; $("exposure-value").textContent = view.exposure + " EV"; draw(); };
  const reset = () => { view.aimed = false; view.zoom = 1; view.x = view.y = 0; view.split = .5; view.exposure = 0; $("exposure").value = 0; $("exposure-value").textContent = "0 EV"; draw(); };
  $("reset").onclick = reset;
  listen(reset);
  const small = d3.select("#strip").selectAll("button").data(labels).enter().append("button").attr("type", "button").attr("aria-label", l => `Put ${l} to the right`);
  small.append("canvas").attr("aria-hidden", "true"); small.append("span").text(l => l);
  small.on("click", function () { $("right").value = d3.select(this).datum(); choose(); });
  viewer.style.maxWidth = `calc(82vh * ${reference.width / reference.height})`;
  new ResizeObserver(() => requestAnimationFrame(resize)).observe(viewer);  // not inside of the observation: it would loop
  choose();
}

function listen(reset) {
  const pointers = new Map(); let sliding = null, pinch = 0;
  const moveSplit = event => { const box = canvas.getBoundingClientRect(); view.split = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)); draw(); };
  $("divider").addEventListener("pointerdown", event => { sliding = event.pointerId; $("divider").setPointerCapture(sliding); event.stopPropagation(); });
  $("divider").addEventListener("pointermove", event => { if (event.pointerId === sliding) { moveSplit(event); event.stopPropagation(); } });
  for (const end of ["pointerup", "pointercancel"]) $("divider").addEventListener(end, () => { sliding = null; });
  viewer.addEventListener("pointerdown", event => { if (sliding === null) { pointers.set(event.pointerId, event); viewer.setPointerCapture(event.pointerId); } });
  viewer.addEventListener("pointermove", event => {
    const last = pointers.get(event.pointerId);
    if (last) pointers.set(event.pointerId, event);
    if (last && pointers.size === 1) {
      const box = canvas.getBoundingClientRect(), scale = view.left.width / box.width / view.zoom;
      view.x -= (event.clientX - last.clientX) * scale; view.y -= (event.clientY - last.clientY) * scale; clampView();
    } else if (pointers.size === 2) {
      const [a, b] = [...pointers.values()], distance = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
      if (pinch) zoomAt(toPicture({clientX: (a.clientX + b.clientX) / 2, clientY: (a.clientY + b.clientY) / 2}), distance / pinch);
      pinch = distance;
    }
    view.cursor = toPicture(event);
    last || view.aimed ? (view.aimed = false, draw()) : tellPixel();
  });
  for (const end of ["pointerup", "pointercancel"]) viewer.addEventListener(end, event => { pointers.delete(event.pointerId); pinch = 0; });
  viewer.addEventListener("wheel", event => { event.preventDefault(); zoomAt(toPicture(event), 2 ** (-event.deltaY / 300)); }, {passive: false});
  $("divider").addEventListener("keydown", event => {
    const step = {ArrowLeft: -.02, ArrowRight: .02, PageUp: .1, PageDown: -.1, Home: -1, End: 1}[event.key];
    if (!step) return;
    view.split = Math.min(1, Math.max(0, view.split + step)); draw(); event.preventDefault(); event.stopPropagation();
  });
  viewer.addEventListener("keydown", event => {
    const step = view.left.width / view.zoom / 12, middle = {x: view.x + view.left.width / view.zoom / 2, y: view.y + view.left.height / view.zoom / 2};
    const moves = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]};
    if (moves[event.key]) { view.x += moves[event.key][0]; view.y += moves[event.key][1]; clampView(); draw(); }
    else if (event.key === "+" || event.key === "=") zoomAt(middle, 1.5);
    else if (event.key === "-") zoomAt(middle, 1 / 1.5);
    else if (event.key === "0") { reset(); event.preventDefault(); return; }
    else return;
    aim(); event.preventDefault();
  });
}

function drawMap(map, canvas, largest) {
  const v = decode(map), bias = map.kind === "bias", colours = bias ? signed : magma, context = canvas.getContext("2d");
  canvas.width = map.width; canvas.height = map.height;
  const image = context.createImageData(map.width, map.height), out = image.data;
  for (let i = 0, o = 0; i < v.length; ++i, o += 4) {
    const t = bias ? .5 + .5 * v[i] / largest : v[i] / largest, at = 3 * Math.round(255 * Math.min(1, Math.max(0, t || 0)));
    out[o] = colours[at]; out[o + 1] = colours[at + 1]; out[o + 2] = colours[at + 2]; out[o + 3] = 255;
  }
  context.putImageData(image, 0, 0);
}
// The size that 99 % of all maps' values stay below, as a power of ten.
function startScale(shown) {
  const sizes = [];
  for (const m of shown) { const v = decode(m); for (let i = 0; i < v.length; i += 17) if (isFinite(v[i])) sizes.push(Math.abs(v[i])); }
  return Math.log10(Math.max(d3.quantile(sizes.sort(d3.ascending), .99) || 0, 1e-3));
}
// The error of one picture in the page, made from its pixels.
function errorMap(picture) {
  const v = decode(picture), values = new Float32Array(v.length / 3);
  for (let i = 0; i < values.length; ++i) values[i] = relativeError(v, 3 * i);
  return {kind: "error", label: picture.label, budget: picture.budget, seed: picture.seed, width: picture.width, height: picture.height, halved: picture.halved, values};
}
function startMaps() {
  const longest = d3.max(pictures, p => p.budget), errors = pictures.filter(p => p !== reference && p.budget === longest).map(errorMap), shown = errors.concat(maps);
  if (!shown.length) { $("maps").textContent = "There are no pictures to measure."; $("map-scale").disabled = true; return; }
  const kinds = ["error", "bias", "deviation"].filter(k => shown.some(m => m.kind === k));
  const rows = d3.select("#maps").selectAll("div").data(kinds).enter().append("div");
  rows.append("h3").text(k => ({error: "Error", bias: "Bias", deviation: "Deviation"})[k]);
  const figures = rows.append("div").attr("class", "maps").selectAll("figure").data(k => shown.filter(m => m.kind === k)).enter().append("figure");
  const title = m => `${m.kind}, ${m.label}, ${figure(m.budget)} s` + (m.kind === "error" ? `, seed ${m.seed}` : "");
  if (!maps.length) d3.select("#maps").append("p").attr("class", "hint").text("Maps of bias and deviation need at least two seeds.");
  figures.append("canvas").attr("role", "img").attr("aria-label", title).on("mousemove", function () {
    const map = d3.select(this).datum(), box = this.getBoundingClientRect(), x = Math.floor((d3.event.clientX - box.left) / box.width * map.width), y = Math.floor((d3.event.clientY - box.top) / box.height * map.height);
    showTip(d3.event, `pixel ${x},${y}${map.halved ? " of the halved map" : ""}\n${map.kind} ${figure(decode(map)[y * map.width + x])}`);
  }).on("mouseleave", () => tip.style("display", "none"));
  figures.append("figcaption").text(m => title(m).slice(m.kind.length + 2));
  const scale = d3.select("#maps").append("div").attr("class", "scale");
  for (const [kind, colours] of [["bias", signed], ["error and deviation", magma]]) {
    const line = scale.append("span"); line.append("span").text(`${kind}: `); line.append("span").attr("class", "low-" + kind.split(" ")[0]);
    const strip = line.append("canvas").attr("width", 256).attr("height", 1).attr("aria-hidden", "true").node(), context = strip.getContext("2d"), image = context.createImageData(256, 1);
    for (let i = 0; i < 256; ++i) image.data.set([colours[3 * i], colours[3 * i + 1], colours[3 * i + 2], 255], 4 * i);
    context.putImageData(image, 0, 0); line.append("span").attr("class", "high-" + kind.split(" ")[0]);
  }
  const update = () => {
    const largest = 10 ** +$("map-scale").value; $("map-scale-value").textContent = "±" + figure(largest, 2);
    figures.select("canvas").each(function (m) { drawMap(m, this, largest); });
    d3.select(".low-bias").text("−" + figure(largest, 2)); d3.select(".high-bias").text("+" + figure(largest, 2)); d3.select(".low-error").text("0"); d3.select(".high-error").text(figure(largest, 2));
  };
  $("map-scale").value = startScale(shown).toFixed(1); $("map-scale").oninput = update; update();
}
