#!/usr/bin/env bash
# Makes `three.js`, `uplot.js` and `uplot.css` anew, each one minified file. Only whoever takes up another version of
# these libraries runs it: it needs npm and its registry, which building Stickslip does not.
#
#   stickslip-cli/src/view/vendor/bundle.sh
set -euo pipefail
cd "$(dirname "$0")"

three=0.187.0
uplot=1.6.32
esbuild=0.28.2

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
npm install --silent --no-audit --no-fund --prefix "$work" "three@$three" "uplot@$uplot" "esbuild@$esbuild"

cat >"$work/three_entry.js" <<'END'
export {
    AmbientLight, BufferAttribute, BufferGeometry, CanvasTexture, ClampToEdgeWrapping, Color, CylinderGeometry,
    DataTexture, DirectionalLight, DoubleSide, DynamicDrawUsage, Group, InstancedMesh, LineBasicMaterial, LineSegments,
    LinearFilter, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, OrthographicCamera, PerspectiveCamera, Plane,
    Points, Quaternion, RGBAFormat, Scene, ShaderMaterial, Sphere, SphereGeometry, Vector2, Vector3, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
END
printf 'export { default } from "uplot";\n' >"$work/uplot_entry.js"

bundle() {
    (cd "$work" && node_modules/.bin/esbuild "$1_entry.js" --bundle --minify --format=esm --legal-comments=none \
        --banner:js="/* $2; see stickslip-cli/licenses */" --outfile="$1.js" --log-level=warning)
    cp "$work/$1.js" .
}
bundle three "three.js $three, MIT"
bundle uplot "uPlot $uplot, MIT"
cp "$work/node_modules/uplot/dist/uPlot.min.css" uplot.css
cp "$work/node_modules/three/LICENSE" ../../../licenses/three.txt
cp "$work/node_modules/uplot/LICENSE" ../../../licenses/uPlot.txt
ls -l three.js uplot.js uplot.css
