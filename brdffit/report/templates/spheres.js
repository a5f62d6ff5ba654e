/* Spheres: two pictures that share a place, and a line that tells which is seen. */

function wipe() {
  find("wipe").style.setProperty("--wipe", `${find("wiper").value}%`);
}

function showSpheres() {
  const frame = spheres.frames[find("frame") ? find("frame").value : 0];
  const right = chosen();
  const asked = find("against") ? find("against").value : "";
  const left = asked || spheres.against[right];
  const words = (name) => (name === "measured" ? "Measured sphere." : `Sphere of ${name}.`);
  const put = (id, name) => {
    for (const each of [id, `${id}-still`]) {
      const picture = find(each);
      if (!picture) continue;
      picture.src = frame.pictures[name];
      picture.alt = words(name);
      const caption = picture.closest("figure").querySelector("figcaption");
      if (each !== id) caption.firstElementChild.textContent = name;
    }
    if (find(`${id}-name`)) find(`${id}-name`).textContent = name;
  };
  put("right", right);
  if (!left) return;
  put("left", left);
  const reference = spheres.against[right];
  find("difference").src = frame.differences[right];
  find("difference").alt =
    `Difference of the two spheres, ${right} minus ${reference}: blue where darker, red where brighter.`;
  find("difference-name").textContent = `${right} \u2212 ${reference}`;
}
