/* The model that is chosen, and what follows it. */

function showModel() {
  for (const part of document.querySelectorAll("[data-model]")) {
    part.hidden = part.dataset.model !== chosen();
  }
  showSpheres();
  if (lobes) drawLobes();
}

if (lobes) prepareLobes();
if (find("wiper")) find("wiper").addEventListener("input", wipe);
for (const id of ["frame", "against"]) {
  if (find(id)) find(id).addEventListener("change", showSpheres);
}
if (find("model")) find("model").addEventListener("change", showModel);
showModel();
