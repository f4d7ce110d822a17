// SPDX-License-Identifier: Apache-2.0
// What mouse, fingers, keys and the panel change, and when it is drawn.

// Column by column: from the object, scaled to a radius of 1, to the screen.
function toClip(state, aspect) {
  const near = 0.05, far = 20, tall = 1 / Math.tan(0.35) / Math.max(1, 1 / aspect);
  const [cy, sy, cx, sx] = [Math.cos(state.azimuth), Math.sin(state.azimuth), Math.cos(state.elevation), Math.sin(state.elevation)];
  const right = [cy, 0, -sy], up = [-sy * sx, cx, -cy * sx], back = [sy * cx, sx, cy * cx];
  const a = (far + near) / (near - far), b = 2 * far * near / (near - far), matrix = [];
  for (let i = 0; i < 3; ++i) matrix.push(right[i] * tall / aspect, up[i] * tall, back[i] * a, -back[i]);
  return matrix.concat([0, 0, -state.distance * a + b, state.distance]);
}

function start(scene) {
  const element = id => document.getElementById(id), canvas = element("view");
  const viewer = new Viewer(canvas, scene);
  const state = { environment: 0, model: "lobe", other: "ao", turn: 0, exposure: scene.exposure, wipe: 1,
                  azimuth: 0.6, elevation: 0.25, distance: 3, spin: false };
  let pending = false, last = 0;

  function frame(time) {
    pending = false;
    if (state.spin && last) {
      state.turn = (state.turn + Math.min(time - last, 100) * 0.02) % 360;
      show();
    }
    last = state.spin ? time : 0;
    viewer.draw(state, toClip(state, canvas.clientWidth / canvas.clientHeight));
    if (state.spin) draw();
  }
  function draw() {
    if (!pending) requestAnimationFrame(frame);
    pending = true;
  }
  function show() {
    const texts = { turn: `${Math.round(state.turn)}°`, exposure: state.exposure.toFixed(1), wipe: `${Math.round(100 * state.wipe)} %` };
    element("turn").value = state.turn;
    element("exposure").value = state.exposure;
    element("wipe").value = 100 * state.wipe;
    for (const [id, text] of Object.entries(texts)) document.querySelector(`output[for=${id}]`).textContent = text;
  }
  function change(values) {
    Object.assign(state, values);
    state.elevation = Math.min(Math.max(state.elevation, -1.5), 1.5);
    state.distance = Math.min(Math.max(state.distance, 1.5), 15);
    state.turn = (state.turn % 360 + 360) % 360;
    show();
    draw();
  }
  const orbit = (across, up) => change({ azimuth: state.azimuth - across, elevation: state.elevation + up });

  const fill = (id, names) => names.forEach((name, value) => element(id).add(new Option(name, value)));
  fill("environment", scene.environments.map(environment => environment.name));
  fill("model", kModels);
  fill("other", kModels);
  element("model").value = kModels.indexOf(state.model);
  element("other").value = kModels.indexOf(state.other);
  element("environment").oninput = event => change({ environment: Number(event.target.value) });
  element("model").oninput = event => change({ model: kModels[event.target.value] });
  element("other").oninput = event => change({ other: kModels[event.target.value], wipe: state.wipe === 1 ? 0.5 : state.wipe });
  element("turn").oninput = event => change({ turn: Number(event.target.value) });
  element("exposure").oninput = event => change({ exposure: Number(event.target.value) });
  element("wipe").oninput = event => change({ wipe: Number(event.target.value) / 100 });
  element("spin").oninput = event => change({ spin: event.target.checked });
  element("panel").onsubmit = event => event.preventDefault();

  const fingers = new Map();
  canvas.onpointerdown = event => {
    fingers.set(event.pointerId, event);
    canvas.setPointerCapture(event.pointerId);
    canvas.focus();
  };
  canvas.onpointerup = canvas.onpointercancel = event => fingers.delete(event.pointerId);
  canvas.onpointermove = event => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const across = (event.clientX - before.clientX) / 150, up = (event.clientY - before.clientY) / 150;
    const spread = () => {
      const [a, b] = [...fingers.values()];
      return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY) || 1;
    };
    const wide = fingers.size === 2 ? spread() : 0;
    fingers.set(event.pointerId, event);
    if (fingers.size === 2) // each of two fingers gives half
      change({ turn: state.turn + 30 * across, distance: state.distance * wide / spread() });
    else if (event.shiftKey) change({ turn: state.turn + 60 * across });
    else orbit(across, up);
  };
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    change({ distance: state.distance * Math.exp(event.deltaY / 1000) });
  }, { passive: false });
  canvas.onkeydown = event => {
    const keys = {
      ArrowLeft: () => orbit(0.1, 0), ArrowRight: () => orbit(-0.1, 0), ArrowUp: () => orbit(0, 0.1), ArrowDown: () => orbit(0, -0.1),
      "[": () => change({ turn: state.turn - 5 }), "]": () => change({ turn: state.turn + 5 }),
      "+": () => change({ distance: state.distance / 1.1 }), "-": () => change({ distance: state.distance * 1.1 }),
    };
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
  };
  new ResizeObserver(draw).observe(canvas);
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  const settle = () => {
    element("spin").disabled = still.matches;
    if (still.matches) { element("spin").checked = false; change({ spin: false }); }
  };
  still.addEventListener("change", settle);
  settle();
  show();
  draw();
  window.vmlight = { state, viewer };
}

try {
  start(JSON.parse(document.getElementById("scene").textContent));
} catch (error) {
  const fault = document.getElementById("fault");
  fault.textContent = error.message;
  fault.hidden = false;
}
