export {AmbientLight, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, InstancedMesh, Matrix4, Mesh, MeshLambertMaterial, OrthographicCamera, Scene, SphereGeometry, Vector3, WebGLRenderer} from 'three';
export {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
export {toCreasedNormals} from 'three/examples/jsm/utils/BufferGeometryUtils.js';
