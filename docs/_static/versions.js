// The versions of this site that lie beside it, and where they lie from its front page: { "0.2.0": "", "0.1.0": "../0.1.0/" }.
// Whoever publishes several versions lists them in this file of each; with fewer than two no list is shown.
var siteVersions = {};
