"use strict";
// The page asks the server for answers, and shows them. It knows no field and no physics.
const LARGEST = 1e7, REST = 300, PATIENCE = 1000, DELAYS = [200, 400, 800, 1600, 3200, 6400];
const one = (selector, root = document) => root.querySelector(selector);
const all = (selector, root = document) => [...root.querySelectorAll(selector)];
let forms = [...document.forms], pending = null, sent = null;
const status = one("output"), problem = one(".error"), note = one(".note");
const id = crypto.randomUUID();
let form, age = 0, timer, patience, request = null, drafting = false, fresh = false;

const inputs = () => all("[name]", form);
const initial = (input) => input.defaultValue ?? input.dataset.default;
const changed = () => inputs().filter((input) => input.value !== initial(input));

function show(state, words) {
  status.dataset.state = state;
  status.textContent = words ?? state;
}

function tell(element, words) {
  element.hidden = !words;
  element.textContent = words ?? "";
}

function question(stage) {
  if (stage === "open") return { card: "own", values: {}, stage, page: id, age, files: pending };
  const values = Object.fromEntries(changed().map((input) => [input.name, input.value]));
  return { card: form.name, values, stage, page: id, age, ...(form.name === "own" && sent && { files: sent }) };
}

// Where the program does not answer, it is asked again until it does, the values change, or the question is given up.
async function post(path, stage, signal) {
  const mine = age, headers = { "Content-Type": "application/json" };
  for (let count = 0; mine === age && !signal?.aborted; count += 1) {
    try {
      const body = JSON.stringify(question(stage));
      const reply = await fetch(path, { method: "POST", headers, body, signal });
      return reply.ok ? await reply.json() : { error: await reply.text() };
    } catch (error) {
      if (signal?.aborted) break;
      if (count === DELAYS.length) {
        tell(problem, "the program no longer answers: start it again");
        show("failed");
      }
      const delay = DELAYS[Math.min(count, DELAYS.length - 1)];
      await new Promise((next) => {
        setTimeout(next, delay);
        signal?.addEventListener("abort", next);
      });
    }
  }
  return { stopped: true };
}

// A draft under way ends before the next is asked, or is given up after a second; all else is given up at once.
function change() {
  age += 1;
  clearTimeout(timer);
  show("busy", "computing …");
  all("[data-part]").forEach((part) => part.classList.add("stale"));
  // The fragment of the address holds the card and the values that differ from its defaults.
  const values = changed().map((input) => [input.dataset.key, input.value]);
  // A step back in the browser's history takes back a change: each has one entry, however many keys it took.
  const link = "#" + new URLSearchParams([["card", form.name], ...values]);
  if (link !== location.hash) history[fresh ? "pushState" : "replaceState"](null, "", link);
  fresh = false;
  if (drafting) {
    const under = request;
    patience ??= setTimeout(() => under.abort(), PATIENCE);
    return;
  }
  request?.abort();
  ask("draft");
}

async function ask(stage) {
  const mine = age, card = form;
  request = new AbortController();
  drafting = stage === "draft";
  const reply = await post("answer", stage, request.signal);
  if (stage !== "draft" && mine !== age) return;
  patience = clearTimeout(patience);
  drafting = false;
  if (card === form && !reply.stopped) put(reply);
  if (mine !== age) return ask("draft");
  if (reply.error) return show("failed");
  if (reply.stopped) return;
  if (!reply.next) return show("done", "solved");
  const state = stage === "draft" ? "draft" : "solved";
  show(state, `${state}, computing …`);
  timer = setTimeout(() => ask(reply.next), stage === "draft" ? REST : 0);
}

function put(reply) {
  tell(problem, reply.error);
  inputs().forEach((input) => input.setCustomValidity(input.name === reply.field ? reply.error : ""));
  if (reply.error) judge(one(".verdict"), { level: "", words: "No answer to these values.", lines: [] });
  for (const [name, content] of Object.entries(reply.parts ?? {})) {
    const part = one(`[data-part="${name}"]`);
    part.classList.remove("stale");
    if (name === "verdict") judge(part, content);
    else if (name === "warnings") list(part, content);
    else if (name === "peak") [one(".name", part).textContent, one("strong", part).textContent] = content;
    else part.innerHTML = content; // pictures and tables, escaped by the server
  }
}

function judge(part, { level, words, lines }) {
  part.dataset.level = level;
  one(".level", part).textContent = level;
  one(".words", part).textContent = words;
  list(one("ul", part), lines);
}

function list(element, texts) {
  element.replaceChildren(...texts.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
}

// Sliders: the value over the default is 20 to their power, or they are linear.
function slide(slider) {
  const input = one("[name]", slider.parentElement), { scale, low, high } = slider.dataset;
  const value = scale === "linear" ? +slider.value : input.defaultValue * 20 ** slider.value;
  input.value = +Math.min(Math.max(value, low), high).toPrecision(3);
}

function follow(input) {
  const slider = one("input[type=range]", input.parentElement), value = +input.value.replace(",", ".").replace("−", "-");
  one(".unit", input.parentElement).hidden = Number.isNaN(value); // a text has its own
  if (!slider || Number.isNaN(value)) return;
  slider.value = slider.dataset.scale === "linear" ? value : Math.log(value / input.defaultValue) / Math.log(20) || 0;
}

// Arrow keys change a number by 1 of its last digit.
function step(input, direction) {
  const digits = /^\s*[-−]?\d+(?:[.,](\d+))?\s*$/.exec(input.value);
  if (!digits) return false;
  const places = digits[1]?.length ?? 0, value = +input.value.replace(",", ".").replace("−", "-");
  input.value = (value + direction / 10 ** places).toFixed(places);
  return true;
}

// A material fills the numbers of a body that it has, and shows its source; another number takes it off again.
// The numbers that it replaces come back with "own numbers".
function choose(select) {
  const { numbers, title, source } = select.selectedOptions[0].dataset, path = `materials.${select.dataset.material}.`;
  const known = numbers ? JSON.parse(numbers) : null;
  for (const input of inputs().filter((one) => one.name.startsWith(path))) {
    const value = known?.[input.name.slice(path.length)];
    if (value !== undefined) {
      input.dataset.own ??= input.value;
      input.value = value === null ? "" : +(value / input.dataset.si).toPrecision(9);
    } else if (input.dataset.own !== undefined) {
      input.value = input.dataset.own;
      delete input.dataset.own;
    }
    follow(input);
  }
  const details = select.parentElement.nextElementSibling, before = all(".material", form).find((other) => other.value === select.value);
  details.hidden = !known || before !== select; // each source once
  details.replaceChildren(Object.assign(document.createElement("summary"), { textContent: title }), source ?? "");
}

function release(input) {
  const select = all(".material", form).find(({ dataset }) => input.name.startsWith(`materials.${dataset.material}.`));
  if (!select) return;
  inputs().forEach((other) => other.name.startsWith(`materials.${select.dataset.material}.`) && delete other.dataset.own);
  select.value = "";
  choose(select);
}

// A line of text fills the fields of the card that its designation names.
async function fill({ value }) {
  const { card, values, asked, error } = await post("answer", "line");
  if (!values) return tell(problem, error);
  form = document.forms.namedItem(card);
  for (const [path, text] of Object.entries({ ...values, line: value })) one(`[name="${path}"]`, form).value = text;
  open(form);
  tell(note, asked.join(". "));
}

// Files are read here, and sent with each question: the program keeps none.
const read = (file) => new Promise((done) => {
  const reader = new FileReader();
  reader.onload = () => done([file.name, reader.result.split(",")[1] ?? ""]);
  reader.onerror = () => done([file.name, ""]);
  reader.readAsDataURL(file);
});

async function take(list) {
  const files = [...list];
  if (!files.length) return;
  if (files.reduce((sum, { size }) => sum + size, 0) > LARGEST) return tell(problem, "the page reads at most 10 MB: use nacre solve");
  all("[data-reading]").forEach((input) => ([input.value, input.parentElement.hidden] = ["", true]));
  pending = { contents: Object.fromEntries(await Promise.all(files.map(read))), reading: {} };
  load();
}

async function load() {
  const asked = pending, { error, ask, form: html, tab } = await post("answer", "open");
  if (asked !== pending) return;
  tell(problem, error);
  if (ask) one(`[data-reading="${ask}"]`).parentElement.hidden = false;
  if (!html) return;
  tell(note);
  sent = pending;
  document.forms.namedItem("own")?.remove();
  one('[data-group="own file"]')?.remove();
  one(".inputs").insertAdjacentHTML("beforeend", html); // escaped by the server
  one("nav").insertAdjacentHTML("beforeend", tab);
  forms = [...document.forms];
  all("[data-reading]").forEach((input) => (input.parentElement.hidden = true));
  open(document.forms.namedItem("own"));
}

function open(card) {
  form = card;
  forms.forEach((other) => (other.hidden = other !== form));
  all(".tab").forEach((tab) => tab.setAttribute("aria-pressed", tab.dataset.group === form.dataset.group));
  all(".variant", form).forEach((select) => (select.value = form.name));
  one("[data-testid=copy-link]").disabled = form.name === "own";
  all('[data-part^="picture"]').forEach((part) => part.replaceChildren());
  all(".material", form).forEach(choose);
  inputs().forEach(follow);
  change();
}

function restore() {
  const { card, ...values } = Object.fromEntries(new URLSearchParams(location.hash.slice(1)));
  const linked = document.forms.namedItem(card), left = [];
  form = linked ?? document.forms.namedItem("own") ?? document.forms.namedItem("contact");
  form.reset();
  inputs().forEach((input) => delete input.dataset.own);
  for (const [key, value] of linked ? Object.entries(values) : []) {
    const input = inputs().find((other) => other.dataset.key === key);
    if (input) input.value = value;
    else left.push(key);
  }
  const unknown = card && !linked ? `The link has a card that is not known here: ${card}` : "";
  tell(note, left.length ? `The link has values that are not known here: ${left.join(", ")}` : unknown);
  fresh = false;
  open(form);
  fresh = true;
}

async function save(path, stage, type, ending) {
  const reply = await post(path, stage);
  tell(problem, reply.stopped ? "the values have changed: ask again" : reply.error);
  if (!reply[stage]) return;
  const href = URL.createObjectURL(new Blob([reply[stage]], { type }));
  Object.assign(document.createElement("a"), { href, download: `${form.name}.${ending}` }).click();
  setTimeout(() => URL.revokeObjectURL(href), 1e4);
}

document.addEventListener("input", ({ target }) => {
  if (target.type === "range") slide(target);
  else if (target.name === "line") return;
  else if (target.name) follow(target);
  else return;
  release(one("[name]", target.parentElement));
  change();
});
document.addEventListener("keydown", (event) => {
  const { target, key } = event, direction = { ArrowUp: 1, ArrowDown: -1 }[key];
  if (direction && target.matches("input[name]") && step(target, direction)) {
    event.preventDefault();
    target.dispatchEvent(new Event("input", { bubbles: true }));
  }
  if (key === "z" && (event.ctrlKey || event.metaKey) && !target.matches("input:not([type=range])")) history.back();
});
document.addEventListener("change", ({ target }) => {
  if (target.name === "line") fill(target);
  if (target.dataset.reading) {
    pending.reading[target.dataset.reading] = target.value;
    load();
  }
  if (target.className === "variant") open(document.forms.namedItem(target.value));
  if (target.className === "material") {
    choose(target);
    change();
  }
  fresh = true;
});
document.addEventListener("focusin", () => (fresh = true)); // what comes next is another change
document.addEventListener("submit", (event) => event.preventDefault());
one("nav").addEventListener("click", ({ target }) => {
  if (target.className !== "tab") return;
  fresh = true;
  open(forms.find((other) => other.dataset.group === target.dataset.group));
});
one("[data-testid=open]").addEventListener("click", () => one("[type=file]").click());
one("[type=file]").addEventListener("change", ({ target }) => take(target.files).then(() => (target.value = "")));
document.addEventListener("dragover", (event) => event.preventDefault());
document.addEventListener("drop", (event) => {
  event.preventDefault();
  take(event.dataTransfer.files);
});
one("[data-testid=finer]").addEventListener("click", () => {
  if (drafting) return;
  clearTimeout(timer);
  request?.abort();
  show("busy", "computing …");
  ask("finer");
});
one("[data-testid=report]").addEventListener("click", () => save("report", "report", "text/html", "html"));
one("[data-testid=case-file]").addEventListener("click", () => save("answer", "case", "application/toml", "toml"));
one("[data-testid=copy-link]").addEventListener("click", () =>
  navigator.clipboard.writeText(location.href).then(() => tell(note, "Link copied."), () => tell(note, "The link is in the address bar.")));
addEventListener("beforeprint", () => all("details:not([open])", form).forEach((one) => (one.dataset.closed = one.open = true)));
addEventListener("afterprint", () => all("details[data-closed]", form).forEach((one) => (one.open = delete one.dataset.closed && false)));
addEventListener("hashchange", restore);
restore();
