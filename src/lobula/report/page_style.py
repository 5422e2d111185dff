"""How the report page looks: its style sheet, light and dark from the shared palette, and the one script it has."""

from __future__ import annotations

from .palette import DARK, LIGHT, Theme


def style() -> str:
    """Return the style sheet of the page."""
    return (
        f":root{{color-scheme:light dark;{_variables(LIGHT)}}}\n"
        f"@media (prefers-color-scheme:dark){{:root{{{_variables(DARK)}}}}}\n{_RULES}"
    )


def _variables(theme: Theme) -> str:
    grounds = {"ground": theme.ground, "panel": theme.panel, "line": theme.line}
    inks = {"text": theme.text, "dim": theme.dim, "hit": theme.collision, **theme.neurons}
    return "".join(f"--{name}:{colour};" for name, colour in {**grounds, **inks}.items())


_RULES = """
*{box-sizing:border-box}
body{margin:0;background:var(--ground);color:var(--text);font:16px/1.5 system-ui,sans-serif;
-webkit-text-size-adjust:100%}
main{max-width:68rem;margin:0 auto;padding:2rem 1.25rem 3rem}
h1{font-size:1.7rem;line-height:1.2;margin:.1rem 0 0;overflow-wrap:anywhere}
h2{font-size:1.1rem;margin:0 0 .8rem}
h3{font-size:1rem;margin:0}
p{margin:0}
a{color:inherit}
section{margin-top:2.2rem}
.over,.none{color:var(--dim)}
.warning{margin-top:.8rem;padding:.6rem .9rem;border-left:.3rem solid var(--hit);background:var(--panel)}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(8rem,1fr));gap:.75rem;margin-top:1.4rem}
.card{background:var(--panel);border-radius:.5rem;padding:.7rem .9rem}
.card b{display:block;font-size:1.5rem;line-height:1.2;font-variant-numeric:tabular-nums}
.card span{color:var(--dim);font-size:.85rem}
.card.alarm b{color:var(--hit)}
video{display:block;width:100%;max-width:40rem;border-radius:.5rem;background:#000}
.row{display:grid;grid-template-columns:9.5rem 1fr;gap:.9rem;margin-bottom:.9rem}
.name b{display:block}
.name span{display:block;color:var(--dim);font-size:.8rem;line-height:1.35}
.plot{position:relative;padding-left:1.9rem}
.plot i{position:absolute;left:0;width:1.6rem;text-align:right;font-style:normal;font-size:.72rem;line-height:1;
color:var(--dim)}
.plot i.top{top:0}
.plot i.bottom{top:4.9rem}
svg{display:block;width:100%;background:var(--panel)}
svg.curve{height:5.6rem}
svg.spikes{height:1.3rem;border-top:1px solid var(--line)}
svg polyline,svg path{fill:none;stroke-width:1.8;vector-effect:non-scaling-stroke;stroke-linejoin:round}
svg path.level{stroke:var(--dim);stroke-width:1;stroke-dasharray:5 4}
rect.hit{fill:var(--hit);opacity:.22}
rect.off{fill:var(--dim);opacity:.22}
.lgmd1{--ink:var(--lgmd1)}.lgmd2{--ink:var(--lgmd2)}.lptc_r{--ink:var(--lptc_r)}.lptc_l{--ink:var(--lptc_l)}
.row b,.values span{color:var(--ink)}
.row polyline,.row .spikes path{stroke:var(--ink)}
.axis{margin:-.5rem 0 0}
.axis .plot{height:1.4rem;margin-left:1.9rem;padding:0}
.axis .plot span{position:absolute;transform:translateX(-50%);font-size:.78rem;color:var(--dim);
font-variant-numeric:tabular-nums}
.axis .name{text-align:right}
.legend{display:flex;flex-wrap:wrap;gap:.3rem 1.4rem;color:var(--dim);font-size:.85rem;margin-top:.4rem}
.legend span::before{content:"";display:inline-block;width:1.1rem;height:.7rem;margin-right:.45rem;
background:var(--dim);opacity:.35}
.legend .hit::before{background:var(--hit);opacity:.45}
.legend .level::before{height:0;background:none;border-top:2px dashed var(--dim);vertical-align:.25rem;opacity:1}
.events{list-style:none;margin:0;padding:0;display:grid;grid-template-columns:repeat(auto-fill,minmax(20rem,1fr));gap:.75rem}
.events li{display:flex;gap:.9rem;background:var(--panel);border-radius:.5rem;overflow:hidden;
border-left:.3rem solid var(--line)}
.events li.alarm{border-color:var(--hit)}
.events li.alarm h3{color:var(--hit)}
.events img,.events .blank{width:9rem;min-height:6.5rem;object-fit:cover;flex:none}
.events .blank{display:grid;place-items:center;color:var(--dim);font-size:.8rem;background:var(--line)}
.events div:last-child{padding:.6rem .8rem .6rem 0;font-size:.88rem;min-width:0}
.events .values{display:flex;flex-wrap:wrap;gap:0 .7rem;font-variant-numeric:tabular-nums}
button{font:inherit;color:inherit;background:none;border:0;border-bottom:1px dotted;padding:0;cursor:pointer}
dl{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(13rem,40%),1fr));gap:.6rem 1.4rem;margin:0}
dt{color:var(--dim);font-size:.8rem}
dd{margin:0;overflow-wrap:anywhere}
summary{cursor:pointer}
summary h2{display:inline}
.wide{overflow-x:auto;margin-top:.8rem}
table{border-collapse:collapse;font-size:.85rem;width:100%}
th,td{text-align:left;vertical-align:top;padding:.35rem .9rem .35rem 0;border-bottom:1px solid var(--line)}
th{color:var(--dim);font-weight:600}
td:first-child{font-family:ui-monospace,monospace}
td:nth-child(2){font-variant-numeric:tabular-nums}
footer{margin-top:2.5rem;padding-top:1rem;border-top:1px solid var(--line);color:var(--dim);font-size:.85rem}
@media (min-width:60rem){
.pair{display:grid;grid-template-columns:32rem 1fr;gap:1.8rem}
.pair .events{max-height:39.5rem;overflow-y:auto;grid-template-columns:1fr}
}
@media (max-width:40rem){
main{padding:1.2rem .9rem 2rem}
.row{grid-template-columns:1fr;gap:.25rem}
.name span{display:inline;margin-right:.7rem}
.axis .name{display:none}
.events{grid-template-columns:1fr}
.events img,.events .blank{width:7rem}
}
@media print{section{break-inside:avoid}}
"""

SCRIPT = """<script>
const video = document.querySelector("video");
document.addEventListener("click", (click) => {
  const at = click.target.dataset.seek;
  if (at === undefined) return;
  video.currentTime = Math.max(0, at - video.dataset.start);
  video.scrollIntoView({behavior: "smooth", block: "center"});
});
</script>"""
