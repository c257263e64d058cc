// The motion as pictures: a WebM film in the time it takes to play, or a frame at each step of time as PNG files in one ZIP archive.

import { download, element, id } from "./dom.js";
import { zip } from "./zip.js";

/** Frames a second. */
const RATES = [10, 25, 30, 60];
/** More frames than this would fill the memory. */
const MOST_FRAMES = 3000;

const picture = (canvas) => new Promise((done, failed) => canvas.toBlob((blob) => (blob ? done(blob) : failed(new Error("the browser gave no picture"))), "image/png"));

export class Recorder {
    constructor(app) {
        this.app = app;
        const options = RATES.map((rate) => element("option", { value: rate, text: `${rate} frames a second` }));
        this.rate = element("select", { "aria-label": "Frames a second" }, ...options);
        this.rate.value = "30";
        this.told = element("p", { role: "status" });
        const button = (text, action) => element("button", { type: "button", text, onclick: action });
        this.buttons = [button("WebM film", () => this.start("webm")), button("PNG frames", () => this.start("png"))];
        this.stop = button("Stop", () => (this.stopped = true));
        this.stop.hidden = true;
        id("record-tools").append(this.rate, ...this.buttons, this.stop, this.told);
        id("record-button").addEventListener("click", () => id("record").showModal());
        id("record").addEventListener("close", () => (this.stopped = true));
        if (!window.MediaRecorder) this.buttons[0].disabled = true;
    }

    async start(kind) {
        this.busy(true);
        try {
            const fps = Number(this.rate.value);
            const blob = kind === "webm" ? await this.film(fps) : await this.frames(fps);
            download(blob, `${this.app.data.name.replace(/[^\w-]+/g, "-") || "plan"}.${kind === "webm" ? "webm" : "zip"}`);
            this.told.textContent = `Saved, ${(blob.size / 1e6).toFixed(1)} MB.`;
        } catch (error) {
            this.told.textContent = `Nothing was saved: ${error.message}`;
        }
        this.busy(false);
    }

    busy(busy) {
        this.buttons.forEach((button) => (button.disabled = busy || (button === this.buttons[0] && !window.MediaRecorder)));
        this.stop.hidden = !busy;
        this.stopped = false;
    }

    /** The whole motion at the chosen speed, frame by frame, however long each takes to draw. */
    async frames(fps) {
        const { player, stage } = this.app;
        const step = player.speed / fps;
        const count = Math.floor((player.end - player.begin) / step + 1e-9) + 1;
        if (count > MOST_FRAMES) throw new Error(`it would be ${count} frames, more than ${MOST_FRAMES}; choose fewer a second, or a higher speed`);
        player.pause();
        const [files, before] = [[], player.time];
        for (let k = 0; k < count && !this.stopped; k++) {
            player.seek(player.begin + k * step);
            stage.setQuick(false);
            stage.draw();
            const blob = await picture(stage.canvas);
            files.push({ name: `frame-${String(k).padStart(5, "0")}.png`, bytes: new Uint8Array(await blob.arrayBuffer()) });
            this.told.textContent = `${k + 1} of ${count} frames`;
        }
        player.seek(before);
        return zip(files);
    }

    /** A film of what the scene shows while the motion plays. */
    film(fps) {
        const { player, stage } = this.app;
        const stream = stage.canvas.captureStream(fps);
        const type = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find((type) => MediaRecorder.isTypeSupported(type));
        if (!type) return Promise.reject(new Error("this browser records no WebM; take PNG frames"));
        const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: 8e6 });
        const parts = [];
        recorder.ondataavailable = ({ data }) => data.size && parts.push(data);
        return new Promise((done, failed) => {
            recorder.onstop = () => done(new Blob(parts, { type: "video/webm" }));
            recorder.onerror = ({ error }) => failed(error ?? new Error("the browser stopped recording"));
            recorder.start(500);
            player.seek(player.begin);
            player.play();
            const watch = () => {
                this.told.textContent = `${player.time.toFixed(1)} of ${player.end.toFixed(1)} s`;
                stage.stale = true;
                if (player.playing && !this.stopped) return requestAnimationFrame(watch);
                player.pause();
                // The last frame has to get there.
                setTimeout(() => recorder.state === "inactive" || recorder.stop(), 200);
            };
            watch();
        });
    }
}
