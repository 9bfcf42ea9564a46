// How quick the page is: pictures a second while the eye goes around, as the reader would feel it, and the time of one
// picture in full [ms].

export async function measure({ stage, cloud, state }, seconds) {
    const { camera, controls } = stage;
    let [pictures, end] = [0, performance.now() + 1000 * seconds];
    const start = performance.now();
    while (performance.now() < end) {
        camera.position
            .sub(controls.target)
            .applyAxisAngle(stage.up, stage.plane ? 0 : 0.02)
            .add(controls.target);
        if (stage.plane) camera.position.x += 1e-3 * state.box.size * Math.sin(pictures);
        if (!stage.plane) camera.lookAt(controls.target);
        stage.move();
        await new Promise((resolve) => requestAnimationFrame(resolve));
        pictures += 1;
    }
    const moving = pictures / ((performance.now() - start) / 1000);
    const drawnMoving = cloud.drawn;
    // Until the picture is drawn in full again.
    while (stage.moving || stage.asked) await new Promise((resolve) => setTimeout(resolve, 50));
    const full = [stage.timed(), stage.timed(), stage.timed()].sort((a, b) => a - b)[1];
    return { moving, drawnMoving, full, drawn: cloud.drawn, particles: state.places.count };
}
