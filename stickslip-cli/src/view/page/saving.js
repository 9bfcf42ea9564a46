// What is seen as a PNG file: the picture, what lies over it, and the bar of colours.

// `layers` are canvases of the same size, the lowest first; `bar` is the element of the bar.
export function picture(layers, bar) {
    const [first] = layers;
    const whole = document.createElement("canvas");
    [whole.width, whole.height] = [first.width, first.height];
    const context = whole.getContext("2d");
    for (const layer of layers) context.drawImage(layer, 0, 0, whole.width, whole.height);
    const frame = first.getBoundingClientRect();
    context.scale(first.width / frame.width, first.height / frame.height);
    context.translate(-frame.left, -frame.top);
    if (!bar.hidden) drawBar(context, bar);
    return whole.toDataURL("image/png");
}

function drawBar(context, bar) {
    const box = (element) => {
        const { left, top, width, height } = element.getBoundingClientRect();
        return [left, top, width, height];
    };
    context.fillStyle = getComputedStyle(bar).backgroundColor;
    context.fillRect(...box(bar));
    const map = bar.querySelector("canvas");
    context.drawImage(map, ...box(map));
    context.textBaseline = "middle";
    for (const text of bar.querySelectorAll("p, span")) {
        const { color, fontWeight, fontSize, fontFamily } = getComputedStyle(text);
        const [left, top, , height] = box(text);
        context.fillStyle = color;
        context.font = `${fontWeight} ${fontSize} ${fontFamily}`;
        context.fillText(text.textContent, left, top + 0.5 * height);
    }
}
