// Draws plots (plotly) and the head (three) over their pictures. Where anything fails the picture stays.
'use strict';

const INK = '#26303a', FAINT = '#8a94a0', GRID = '#e3e7eb';

const PLOT_LAYOUT = {
  font: {family: 'system-ui, -apple-system, "Segoe UI", Roboto, "Liberation Sans", Arial, sans-serif', size: 12.5, color: INK},
  paper_bgcolor: 'white', plot_bgcolor: 'white', hovermode: 'x unified',
  margin: {t: 12, r: 16, b: 8, l: 8},
  legend: {orientation: 'h', x: 0.5, xanchor: 'center', y: 1.02, yanchor: 'bottom'},
  hoverlabel: {namelength: -1},
};
const PLOT_AXIS = {linecolor: FAINT, linewidth: 1, showline: true, ticks: 'outside', ticklen: 4, tickcolor: FAINT, gridcolor: GRID,
                   zerolinecolor: FAINT, zerolinewidth: 1, automargin: true, title: {standoff: 8}};

function isObject(value) {
  return value !== null && typeof value === 'object' && !Array.isArray(value);
}

/// `over` laid over `base`, objects key by key.
function merged(base, over) {
  const result = {...base};
  for (const [key, value] of Object.entries(over)) {
    result[key] = isObject(value) && isObject(base[key]) ? merged(base[key], value) : value;
  }
  return result;
}

function drawPlot(place, {data, layout}) {
  const whole = merged(PLOT_LAYOUT, layout);
  for (const axis of Object.keys(whole).filter((key) => /^[xy]axis/.test(key))) whole[axis] = merged(PLOT_AXIS, whole[axis]);
  place.style.height = `${layout.height}px`;
  // Drag to zoom, double click to go back: the bar of buttons would cover the legend.
  return Plotly.newPlot(place, data, whole, {responsive: true, displayModeBar: false});
}

function bytesOf(base64) {
  return Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)).buffer;
}

function once(make) {
  let made;
  return () => made ??= make();
}

/// Surface of head_view.hpp: corners on a grid of 16 bits over its box, triangles as their numbers.
function surfaceGeometry({low, step, points, triangles}) {
  const onGrid = new Uint16Array(bytesOf(points)), corners = new Float32Array(onGrid.length);
  for (let i = 0; i < onGrid.length; ++i) corners[i] = low[i % 3] + step * onGrid[i];
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(corners, 3));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(bytesOf(triangles)), 1));
  return THREE.toCreasedNormals(geometry, 0.6);
}

const surfaces = once(() => JSON.parse(document.getElementById('surfaces').textContent).map(surfaceGeometry));

/// Draws every head of the page, one after the other: browsers allow a page only a few WebGL contexts.
const painter = once(() => new THREE.WebGLRenderer({antialias: true, alpha: true}));

function rockMesh({colour, spheres}) {
  const mesh = new THREE.InstancedMesh(new THREE.SphereGeometry(1, 20, 14), new THREE.MeshLambertMaterial({color: colour}), spheres.length);
  spheres.forEach(([x, y, z, radius], i) => mesh.setMatrixAt(i, new THREE.Matrix4().makeScale(radius, radius, radius).setPosition(x, y, z)));
  return mesh;
}

function drawHead(place, head) {
  const scene = new THREE.Scene(), vector = (xyz) => new THREE.Vector3(...xyz);
  const steel = new THREE.MeshLambertMaterial({color: '#a9b4be', side: THREE.DoubleSide});
  const ghost = new THREE.MeshLambertMaterial({color: '#8a94a0', side: THREE.DoubleSide, transparent: true, opacity: 0.22, depthWrite: false});
  const soil = new THREE.MeshLambertMaterial({color: '#b89461', side: THREE.DoubleSide, transparent: true, opacity: 0.5});
  const cutter = new THREE.Mesh(surfaces()[head.steel], steel);
  cutter.rotation.z = head.steel_angle;
  const meshes = (numbers, material) => numbers.map((surface) => new THREE.Mesh(surfaces()[surface], material));
  scene.add(cutter, ...head.rocks.map(rockMesh), ...meshes(head.soil, soil), ...meshes(head.ghosts, ghost));

  const camera = new THREE.OrthographicCamera(), centre = vector(head.centre);
  camera.up = vector(head.up);
  camera.position.copy(centre).addScaledVector(vector(head.towards), 4 * head.height_m);
  camera.far = 12 * head.height_m;
  const lamp = new THREE.DirectionalLight('white', 2.2);
  camera.add(lamp, lamp.target);
  lamp.position.set(-0.5, 0.8, 1);
  lamp.target.position.set(0, 0, -1);
  scene.add(camera, new THREE.AmbientLight('white', 1.3));

  const renderer = painter(), canvas = document.createElement('canvas'), picture = canvas.getContext('2d');
  place.append(canvas);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.target.copy(centre);
  // The wheel scrolls the page until the view was taken hold of.
  controls.enableZoom = false;
  canvas.addEventListener('pointerdown', () => { controls.enableZoom = true; });
  canvas.addEventListener('pointerleave', () => { controls.enableZoom = false; });

  const render = () => {
    const {width, height} = renderer.domElement;
    if (width !== canvas.width || height !== canvas.height) renderer.setSize(canvas.width, canvas.height, false);
    renderer.render(scene, camera);
    picture.clearRect(0, 0, canvas.width, canvas.height);
    picture.drawImage(renderer.domElement, 0, 0);
  };
  const fit = () => {
    const width = place.clientWidth, density = Math.min(2, devicePixelRatio);
    if (width === 0) return;
    canvas.width = Math.round(density * width);
    canvas.height = Math.round(canvas.width / head.aspect);
    camera.top = 0.5 * head.height_m;
    camera.right = camera.top * head.aspect;
    camera.bottom = -camera.top;
    camera.left = -camera.right;
    camera.updateProjectionMatrix();
    render();
  };
  controls.addEventListener('change', render);
  controls.update();
  fit();
  new ResizeObserver(fit).observe(place);
}

const DRAW = {plot: drawPlot, head: drawHead};

async function replace(element) {
  const place = document.createElement('div');
  place.className = 'live';
  element.append(place);
  element.classList.add('drawn');
  try {
    await DRAW[element.dataset.kind](place, JSON.parse(element.querySelector('script').textContent));
  } catch (error) {
    element.classList.remove('drawn');
    place.remove();
    console.warn(`The ${element.dataset.kind} stays a picture: ${error.message}`);
  }
}

document.querySelectorAll('.replaceable').forEach(replace);
