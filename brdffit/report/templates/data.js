"use strict";

/* What the page was given. */

const find = (id) => document.getElementById(id);
const read = (id) => JSON.parse(find(id).textContent);
const spheres = read("spheres-data");
const lobes = read("lobes-data");
const names = Object.keys(spheres.frames[0].pictures).filter((name) => name !== "measured");
const chosen = () => (find("model") ? find("model").value : names[0]);
