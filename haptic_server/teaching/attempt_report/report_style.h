// How a report looks, on a screen and on A4. It names no font and no file from elsewhere.
#pragma once

namespace bonemill {

inline constexpr char kReportStyle[] = R"(
@page{size:A4;margin:10mm}
*{box-sizing:border-box}
body{font:8pt/1.3 system-ui,sans-serif;color:#1b1f24;background:#fff;max-width:190mm;margin:0 auto;padding:4mm 0;
print-color-adjust:exact;-webkit-print-color-adjust:exact}
h1{font-size:13pt;margin:0}h2{font-size:8.5pt;margin:0 0 1mm;border-bottom:.3mm solid #d4d8dd}
p{margin:.5mm 0}section{margin:1.8mm 0 0;break-inside:avoid}
header{display:flex;justify-content:space-between;align-items:center;gap:6mm}
.verdict{font-size:11pt;font-weight:600;padding:1.5mm 4mm;border-radius:1.5mm;border:.4mm solid;white-space:nowrap}
.verdict.passed{color:#0b5d33;background:#e5f4ec}.verdict.failed{color:#9b1c1c;background:#fdeaea}
.verdict.none{color:#555;font-weight:400;font-size:9.5pt}
.top{display:flex;gap:5mm;align-items:flex-start}.top>div{flex:1}
table{border-collapse:collapse;width:100%}td,th{padding:.2mm 1mm;text-align:left;vertical-align:top}
th{font-weight:400;color:#59626c}.n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}
.gates td:first-child{white-space:nowrap;font-weight:600}.gates .passed td:first-child{color:#0b5d33}
.gates .failed td{color:#9b1c1c}.scores td:first-child{width:40%}.scores .score{width:30mm}.scores svg{height:2.4mm;width:30mm}
.total{margin-top:1mm}
.pictures{width:46mm;flex:none}figure{margin:0}figure img{width:100%;max-height:46mm;object-fit:contain}
figcaption{font-size:7.5pt;color:#59626c}
svg{width:100%;height:auto;display:block}svg text{font-size:8px;fill:#59626c;font-family:inherit}
svg .title{fill:#1b1f24}svg .frame{fill:none;stroke:#c9ced4;stroke-width:.7}
svg path{fill:none;stroke-width:1.2;stroke-linejoin:round;stroke-linecap:round}
svg .force{stroke:#14508c}svg .peak{stroke:#14508c;stroke-width:.5;opacity:.6}svg .removed{stroke:#6b4a1e}
svg .distance{stroke:#0b5d33}svg .heat{stroke:#9b1c1c}svg .curve{stroke:#14508c;stroke-dasharray:3 2}
svg path.mark{stroke:#9b1c1c;stroke-width:.7;stroke-dasharray:2 2}svg circle.mark{fill:#9b1c1c}
svg .number{fill:#fff;font-weight:600}svg .bar{fill:#14508c}svg .band{fill:#cfdceb}
svg .dot{fill:#fff;stroke:#14508c;stroke-width:1.2}svg .dot.last{fill:#14508c}
.moments td{padding:.2mm 1.2mm}.moments .mark{color:#9b1c1c;font-weight:600;width:5mm}
code{font:7pt ui-monospace,monospace;color:#59626c}
.charts{display:flex;flex-wrap:wrap;gap:3mm}.charts figure{width:60mm}
.all{columns:3;column-gap:4mm;break-inside:auto}.all h2{column-span:all}
.figures{font-size:5.6pt;line-height:1.12}.figures td:first-child{width:100%}.figures tr{break-inside:avoid}.figures td{padding:.05mm .4mm;border-bottom:.1mm solid #e6e9ec}
.figures .id{color:#8a929b}.far{font-weight:700}
footer{margin-top:1.5mm;font-size:6pt;color:#59626c}
@media screen{body{padding:8mm}}
)";

}  // namespace bonemill
