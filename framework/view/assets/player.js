// The play head: time, speed, playing or not; tells everybody who listens. Its clock lasts as long as the longest of the plans,
// or the chosen one, through whose segments it steps.

export class Player {
    constructor(motion) {
        this.motion = motion;
        [this.begin, this.end] = [motion.begin, motion.end];
        this.time = this.begin;
        this.speed = 1;
        this.playing = false;
        this.listeners = [];
    }

    setSpan([begin, end]) {
        [this.begin, this.end] = [begin, end];
        this.time = Math.min(Math.max(this.time, begin), end);
    }

    onChange(listener) {
        this.listeners.push(listener);
    }

    tell() {
        this.listeners.forEach((listener) => listener(this));
    }

    seek(time) {
        this.time = Math.min(Math.max(time, this.begin), this.end);
        this.tell();
    }

    play() {
        if (this.end <= this.begin) return;
        if (this.time >= this.end) this.time = this.begin;
        this.playing = true;
        this.last = null;
        this.tell();
    }

    pause() {
        this.playing = false;
        this.tell();
    }

    togglePlay() {
        if (this.playing) this.pause();
        else this.play();
    }

    setSpeed(speed) {
        this.speed = speed;
        this.tell();
    }

    /** Moves on by what has passed since the last call; `now` in milliseconds. */
    tick(now) {
        if (!this.playing) return;
        const passed = this.last === null ? 0 : (now - this.last) / 1000;
        this.last = now;
        // A page that was asleep does not jump.
        this.time += Math.min(passed, 0.25) * this.speed;
        if (this.time >= this.end) {
            this.time = this.end;
            this.playing = false;
        }
        this.tell();
    }

    segment() {
        return this.motion.locate(this.time).segment;
    }

    /** To the start of the next segment, or of this one and then the one before. */
    stepSegment(direction) {
        if (!this.motion.segments.length) return;
        const here = this.motion.segments[this.segment()];
        this.playing = false;
        if (direction > 0) this.seek(here.end > this.time || here.index + 1 === this.motion.segments.length ? here.end : this.motion.segments[here.index + 1].end);
        else if (this.time > here.start + 1e-6) this.seek(here.start);
        else this.seek(this.motion.segments[Math.max(here.index - 1, 0)].start);
    }

    /** To the next or the last state of the plan. */
    stepState(direction) {
        const { time } = this.motion;
        this.playing = false;
        const target = direction > 0 ? time.find((t) => t > this.time + 1e-9) : time.findLast((t) => t < this.time - 1e-9);
        this.seek(target ?? this.time);
    }
}
