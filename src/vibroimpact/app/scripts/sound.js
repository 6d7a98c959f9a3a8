// The sound of a plate: the signal of a sensor through the audio of the browser, as it is or slowed.
"use strict";

{
  let context = null, playing = null;

  // Play a signal of a rate [Hz], slowed by a factor; call `ended` when it ends. Its largest magnitude is as loud as may be.
  vibroimpact.playSound = (signal, slowed, ended) => {
    vibroimpact.stopSound();
    context = context || new AudioContext();
    context.resume();
    const largest = signal.value.reduce((most, value) => (Math.abs(value) > most ? Math.abs(value) : most), 0) || 1;
    // browsers take rates from 8 kHz on: a slower one is played slower
    const rate = Math.min(Math.max(signal.rate, 8000), 96000);
    const buffer = context.createBuffer(1, signal.value.length, rate);
    buffer.copyToChannel(Float32Array.from(signal.value, (value) => 0.9 * value / largest), 0);
    const source = new AudioBufferSourceNode(context, { buffer, playbackRate: signal.rate / rate / slowed });
    source.connect(context.destination);
    source.onended = () => { if (playing === source) playing = null; ended(); };
    source.start();
    playing = source;
    return buffer.duration / source.playbackRate.value;
  };

  vibroimpact.stopSound = () => { if (playing) playing.stop(); playing = null; };
}
