import { Browser, Program, serve, pause } from "./harness.mjs";
const site = await serve("/tmp/wt/web/web/dist");
const b = await Browser.start("/usr/bin/chromium", "/tmp/target/web/shots");
b.open(site.url + "?scene=chess").catch(e=>console.log("open", String(e)));
for (let i=0;i<6;i++){ await pause(3000); console.log(i, b.faults, await b.page?.evaluate(()=>[...document.querySelectorAll('dd')].slice(0,5).map(x=>x.textContent).join('|')+' err:'+document.getElementById('error').textContent+document.activeElement?.id)); }
console.log('samples');
b.samples(4).then(()=>console.log('done'),e=>console.log(String(e)));
for (let i=0;i<4;i++){ await pause(3000); console.log(i, b.faults, await b.page?.evaluate(()=>[...document.querySelectorAll('dd')].slice(0,5).map(x=>x.textContent).join('|')+' err:'+document.getElementById('error').textContent+document.activeElement?.id+document.getElementById('wanted').value)); }
process.exit();
