use stickslip::{engine, lanes::Processor, scene};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let (basis, precision, n, steps) =
        (&a[1], &a[2], a[3].parse::<f64>().unwrap(), a[4].parse::<usize>().unwrap());
    let path = match a.get(5).map(|s| s.as_str()) {
        Some("ref") => engine::Path::Reference,
        Some("any") => engine::Path::Lanes(Processor::Any),
        Some("avx2") => engine::Path::Lanes(Processor::Avx2),
        _ => engine::Path::Lanes(Processor::best()),
    };
    let threads = a.get(6).map_or(1, |t| t.parse().unwrap());
    let update = a.get(7).cloned().unwrap_or("modified-last".into());
    let speed: f64 = a.get(8).map_or(3.0, |t| t.parse().unwrap());
    let text = format!(
        r#"
        space = {{ dimension = "3d", cell = 0.1, basis = "{basis}", precision = "{precision}" }}
        time = {{ end = 1, stress_update = "{update}" }}
        materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "a"
        material = "rubber"
        shape.box = {{ min = [0,0,0], max = [{0},{0},{0}] }}
        velocity = [{speed}, {1}, {2}]
        spin = [0.1, 0.2, 0.3]
    "#,
        n * 0.1,
        speed * 0.7,
        speed * 0.4
    );
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().unwrap();
    let loaded = scene::parse("t.toml", &text, &[]).unwrap();
    let mut sim = engine::build_on(&loaded.scene, path).unwrap();
    sim.step(f64::INFINITY).unwrap();
    let mut best = f64::INFINITY;
    let mut total = 0.0;
    let cpu = || {
        let s = std::fs::read_to_string("/proc/self/stat").unwrap();
        let f: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect();
        (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) / 100.0
    };
    let c0 = cpu();
    let t0 = std::time::Instant::now();
    for _ in 0..steps {
        let t = std::time::Instant::now();
        sim.step(f64::INFINITY).unwrap();
        let e = t.elapsed().as_secs_f64();
        best = best.min(e);
        total += e;
    }
    let p = sim.particles() as f64;
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let hwm: f64 = status
        .lines()
        .find(|l| l.starts_with("VmHWM"))
        .unwrap()
        .split_whitespace()
        .nth(1)
        .unwrap()
        .parse()
        .unwrap();
    println!(
        "{basis} {precision} {update} {p} particles: best step {:.2} M/s, mean {:.2}, per cpu-second {:.2}  wall {:.2}  peak {:.0} B/particle",
        p / best / 1e6,
        p * steps as f64 / total / 1e6,
        p * steps as f64 / (cpu() - c0) / 1e6,
        t0.elapsed().as_secs_f64(),
        hwm * 1024.0 / p
    );
    for (v, s) in sim.timings() {
        print!("{v} {:.1} ns  ", s / (p * (steps + 1) as f64) * 1e9);
    }
    println!("\n{:?}", sim.ledger().total);
}
