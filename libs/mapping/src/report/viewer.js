// The 3D view of report.html: the embedded GLB, lines, corners and the body's way, in a frame that is
// level with the map. Draws only when something changed.
(function () {
  'use strict';
  var views = document.querySelector('.views');
  var canvas = document.getElementById('canvas');
  var caption = document.getElementById('caption');

  var renderer;
  try {
    renderer = new THREE.WebGLRenderer(
        {canvas: canvas, antialias: true, alpha: true, preserveDrawingBuffer: true});  // kept: to print
  } catch (error) {
    views.classList.add('flat');
    caption.textContent = 'No 3D view: this browser offers no WebGL. The floor plan shows the same map.';
    return;
  }
  canvas.hidden = false;
  document.getElementById('controls').hidden = false;
  caption.textContent = 'Turn: left button. Move: right button. Zoom: wheel.';
  renderer.gammaOutput = true;  // the mesh's colours are linear
  renderer.setPixelRatio(window.devicePixelRatio);

  var data = JSON.parse(document.getElementById('scene').textContent);
  var scene = new THREE.Scene();
  var camera = new THREE.PerspectiveCamera(45, 1, 0.01, 1000);
  camera.up.set(0, 0, 1);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x8c8c8c, 0.95));
  var lamp = new THREE.DirectionalLight(0xffffff, 0.35);
  lamp.position.set(0.3, 0.5, 1);
  camera.add(lamp);
  scene.add(camera);
  var controls = new THREE.OrbitControls(camera, canvas);

  var map = new THREE.Group();
  var m = data.level_from_map;
  map.quaternion.set(m[0], m[1], m[2], m[3]);
  scene.add(map);
  var meshes = new THREE.Group();
  var edges = new THREE.Group();
  var way = new THREE.Group();
  map.add(meshes, edges, way);

  function geometryOf(points) {
    var geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute([].concat.apply([], points), 3));
    return geometry;
  }

  function dots(points, color, size) {
    return new THREE.Points(
        geometryOf(points),
        new THREE.PointsMaterial({color: color, size: size * window.devicePixelRatio, sizeAttenuation: false}));
  }

  var dark = new THREE.Color(0x30343a).convertSRGBToLinear();
  var red = new THREE.Color(0xd03a2b).convertSRGBToLinear();
  edges.add(new THREE.LineSegments(geometryOf(data.lines), new THREE.LineBasicMaterial({color: dark})));
  edges.add(dots(data.corners, dark, 5));
  data.way.forEach(function (stretch) {
    way.add(new THREE.Line(geometryOf(stretch), new THREE.LineBasicMaterial({color: red})));
    way.add(dots(stretch, red, 2.5));
  });
  way.renderOrder = 1;  // over the planes: a robot's way lies in the floor
  way.children.forEach(function (object) { object.material.depthTest = false; });

  function draw() {
    renderer.render(scene, camera);
  }

  function resize() {
    renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
    camera.aspect = canvas.clientWidth / canvas.clientHeight;
    camera.updateProjectionMatrix();
    draw();
  }

  // All vertices of what there is, in the level frame.
  function vertices() {
    var all = [];
    map.updateMatrixWorld(true);
    map.traverse(function (object) {
      if (!object.geometry) return;
      var positions = object.geometry.getAttribute('position');
      for (var i = 0; i < positions.count; ++i) {
        all.push(new THREE.Vector3().fromBufferAttribute(positions, i).applyMatrix4(object.matrixWorld));
      }
    });
    return all;
  }

  // Looks at the middle of all there is from the azimuth and elevation given [rad], as near as shows it
  // all.
  function lookFrom(azimuth, elevation) {
    var all = vertices();
    var box = new THREE.Box3().setFromPoints(all);
    if (box.isEmpty()) box.set(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1));
    var middle = box.getCenter(new THREE.Vector3());
    var back = new THREE.Vector3(Math.cos(azimuth) * Math.cos(elevation),
                                 Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation));
    var right = new THREE.Vector3().crossVectors(camera.up, back).normalize();
    var up = new THREE.Vector3().crossVectors(back, right);
    var slope = 0.95 * Math.tan(THREE.Math.degToRad(camera.fov) / 2);  // a margin
    var distance = all.reduce(function (farthest, vertex) {
      vertex.sub(middle);
      var aside = Math.max(Math.abs(vertex.dot(up)), Math.abs(vertex.dot(right)) / camera.aspect);
      return Math.max(farthest, aside / slope + vertex.dot(back));
    }, 0.1);
    camera.near = distance / 500;
    camera.far = distance * 20;
    camera.updateProjectionMatrix();
    camera.position.copy(back).multiplyScalar(distance).add(middle);
    controls.target.copy(middle);
    controls.update();
    draw();
  }

  function lookAskance() {
    lookFrom(-2.2, 0.7);
  }

  function onChange(id, act) {
    var box = document.getElementById(id);
    box.addEventListener('change', function () {
      act(box.checked);
      draw();
    });
    act(box.checked);
  }

  function setSides(both) {
    // From one side only, one looks into a room from outside.
    meshes.traverse(function (object) {
      if (object.material) object.material.side = both ? THREE.DoubleSide : THREE.FrontSide;
      if (object.material) object.material.needsUpdate = true;
    });
  }

  function start() {
    onChange('planes', function (on) { meshes.visible = on; });
    onChange('edges', function (on) { edges.visible = on; });
    onChange('way', function (on) { way.visible = on; });
    onChange('backs', setSides);
    document.getElementById('fit').addEventListener('click', lookAskance);
    document.getElementById('above').addEventListener('click', function () { lookFrom(-Math.PI / 2, Math.PI / 2 - 1e-3); });
    controls.addEventListener('change', draw);
    window.addEventListener('resize', resize);
    resize();
    lookAskance();
  }

  var bytes = Uint8Array.from(atob(document.getElementById('glb').textContent), function (c) { return c.charCodeAt(0); });
  new THREE.GLTFLoader().parse(bytes.buffer, '', function (gltf) {
    gltf.scene.rotation.x = Math.PI / 2;  // glTF's y up back to z up
    gltf.scene.traverse(function (object) {
      if (!object.material) return;
      object.material.polygonOffset = true;  // lines on a plane lie before it
      object.material.polygonOffsetFactor = 1;
      object.material.polygonOffsetUnits = 1;
    });
    meshes.add(gltf.scene);
    start();
  }, function (error) {
    caption.textContent = 'The mesh cannot be shown: ' + error.message;
    start();
  });
})();
