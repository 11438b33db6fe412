//! Matching where walls stand: the cost of a pair is its way around them.

use glam::Vec2;
use lightloom_core::Progress;
use lightloom_core::constraint::visibility::SearchBuffers;
use lightloom_core::constraint::{ActiveWall, VisibilityGraph, Wall, Window};
use lightloom_core::matching::{Matching, WallMap, transport_map};
use lightloom_core::math::rng::{Purpose, Stream};

fn graph(walls: &[&[[f32; 2]]]) -> VisibilityGraph {
    let active = |points: &&[[f32; 2]]| {
        Wall { thickness: 0.01, ..Wall::new(points.to_vec()) }.active(Window::ALWAYS).unwrap()
    };
    let walls: Vec<ActiveWall> = walls.iter().map(active).collect();
    VisibilityGraph::new(&walls.iter().collect::<Vec<_>>(), Vec2::ONE, &Progress::new()).unwrap()
}

/// Points spread over rectangles given by two corners, as many in each.
fn spread(count: usize, pass: u64, rectangles: &[[[f32; 2]; 2]]) -> Vec<Vec2> {
    (0..count)
        .map(|i| {
            let mut random = Stream::new(11, Purpose::Target, pass, i as u64);
            let [low, high] = rectangles[i % rectangles.len()].map(Vec2::from);
            low + (high - low) * Vec2::new(random.f32(), random.f32())
        })
        .collect()
}

fn around(source: &[Vec2], target: &[Vec2], map: &WallMap, graph: &VisibilityGraph, pass: u64) -> Vec<Vec2> {
    let matching = Matching::around_walls(source, target, (map, graph), 1, pass, &Progress::new()).unwrap();
    assert!(matching.is_bijection());
    matching.target_of.iter().map(|&row| target[row as usize]).collect()
}

/// Mean squared length of the ways of pairs that a way connects, and the number of the others.
fn cost(source: &[Vec2], targets: &[Vec2], graph: &VisibilityGraph) -> (f64, usize) {
    let mut buffers = SearchBuffers::default();
    let lengths: Vec<f64> =
        source.iter().zip(targets).map(|(a, b)| f64::from(graph.distance(*a, *b, &mut buffers))).collect();
    let open: Vec<f64> = lengths.iter().copied().filter(|length| length.is_finite()).collect();
    (open.iter().map(|length| length * length).sum::<f64>() / open.len() as f64, lengths.len() - open.len())
}

fn straight(source: &[Vec2], target: &[Vec2]) -> Vec<Vec2> {
    let map = transport_map(source, target, Vec2::ONE, &Progress::new()).unwrap();
    let matching = Matching::new(source, target, &map, 1, 0, &Progress::new()).unwrap();
    matching.target_of.iter().map(|&row| target[row as usize]).collect()
}

/// Light on both sides of a wall, and as much room for it on either side: nobody has to go around.
#[test]
fn light_stays_on_its_side_where_there_is_room_for_it() {
    let graph = graph(&[&[[0.2, 0.5], [1.0, 0.5]]]);
    // Straight on, the upper light would go down: its targets lie below the wall, just as near.
    let source = spread(8000, 0, &[[[0.5, 0.4], [0.9, 0.49]], [[0.5, 0.51], [0.9, 0.6]]]);
    let target = spread(8000, 1, &[[[0.5, 0.1], [0.9, 0.49]], [[0.5, 0.51], [0.9, 0.55]]]);
    let map = WallMap::new(&source, &target, &graph, &Progress::new()).unwrap();
    let targets = around(&source, &target, &map, &graph, 0);
    let crossing = |targets: &[Vec2]| {
        source.iter().zip(targets).filter(|(a, b)| graph.barriers().blocks(**a, **b)).count()
    };
    // Cells of photons may straddle the wall: about 32 of 1024 lie at it, and half of their photons beyond.
    assert!(crossing(&targets) * 100 < source.len(), "{} go around", crossing(&targets));
    let (ours, _) = cost(&source, &targets, &graph);
    let (without, _) = cost(&source, &straight(&source, &target), &graph);
    println!(
        "{ours} against {without}, {} against {}",
        crossing(&targets),
        crossing(&straight(&source, &target))
    );
    assert!(ours < without);
}

#[test]
fn nobody_is_shut_off_where_each_room_has_as_many_places_as_photons() {
    let square: &[[f32; 2]] = &[[0.4, 0.4], [0.6, 0.4], [0.6, 0.6], [0.4, 0.6], [0.4, 0.4]];
    let graph = graph(&[square]);
    let inside = [[0.41, 0.41], [0.59, 0.59]];
    let source = spread(4096, 0, &[inside, [[0.0, 0.0], [0.38, 1.0]]]);
    let target = spread(4096, 1, &[[[0.62, 0.0], [1.0, 1.0]], inside]);
    let map = WallMap::new(&source, &target, &graph, &Progress::new()).unwrap();
    let (_, shut_off) = cost(&source, &around(&source, &target, &map, &graph, 0), &graph);
    let (_, straight) = cost(&source, &straight(&source, &target), &graph);
    println!("{shut_off} shut off, {straight} by straight ways");
    // Cells of photons may straddle the wall: each of the two sets has 1024 of them, about 64 at the wall.
    assert!(shut_off * 50 < source.len() && straight > source.len() / 10, "{shut_off}, {straight}");
}

/// The bound of a discrete optimum: no map can be cheaper than the ways of the cheapest assignment of a sample.
#[test]
fn around_a_wall_the_cost_is_near_the_optimum_of_a_sample() {
    let graph = graph(&[&[[0.5, 0.2], [0.5, 0.8]]]);
    let source = spread(20_000, 0, &[[[0.2, 0.4], [0.4, 0.6]]]);
    let target = spread(20_000, 1, &[[[0.6, 0.4], [0.8, 0.6]]]);
    let map = WallMap::new(&source, &target, &graph, &Progress::new()).unwrap();
    let targets = around(&source, &target, &map, &graph, 0);
    let (ours, shut_off) = cost(&source, &targets, &graph);
    assert_eq!(shut_off, 0);
    // 2048 of both, matched alone, and refined: their own map is as good as ours can be.
    let sample = |points: &[Vec2]| points.iter().copied().take(2048).collect::<Vec<_>>();
    let (few, fewer) = (sample(&source), sample(&target));
    let own = WallMap::new(&few, &fewer, &graph, &Progress::new()).unwrap();
    let (reference, _) = cost(&few, &around(&few, &fewer, &own, &graph, 0), &graph);
    println!("{ours} against {reference}");
    // Half of the light goes around either end; the sample's own noise is 1 / sqrt(2048) of the spread.
    assert!(ours < 1.02 * reference, "{ours} against {reference}");
}

/// Compared with straight ways where no wall stands: there, too, random points of two passes differ by their own noise.
#[test]
fn later_passes_go_where_the_first_one_went() {
    let walled = graph(&[&[[0.5, 0.2], [0.5, 0.8]]]);
    let of_pass = |pass: u64| {
        (
            spread(20_000, 2 * pass, &[[[0.2, 0.3], [0.4, 0.7]]]),
            spread(20_000, 2 * pass + 1, &[[[0.6, 0.3], [0.8, 0.7]]]),
        )
    };
    let (first, second) = (of_pass(0), of_pass(1));
    let map = WallMap::new(&first.0, &first.1, &walled, &Progress::new()).unwrap();
    let ours = [(&first, 0), (&second, 1)].map(|((a, b), pass)| around(a, b, &map, &walled, pass));
    let map = transport_map(&first.0, &first.1, Vec2::ONE, &Progress::new()).unwrap();
    let free = [(&first, 0), (&second, 1)].map(|((a, b), pass)| {
        let matching = Matching::new(a, b, &map, 1, pass, &Progress::new()).unwrap();
        matching.target_of.iter().map(|&row| b[row as usize]).collect::<Vec<_>>()
    });
    let apart = |targets: &[Vec<Vec2>; 2]| {
        let mut apart: Vec<f32> = (0..second.0.len())
            .step_by(20)
            .map(|i| {
                let distance = |k: &usize| first.0[*k].distance_squared(second.0[i]);
                let nearest = (0..first.0.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
                targets[0][nearest].distance(targets[1][i])
            })
            .collect();
        apart.sort_by(f32::total_cmp);
        apart[apart.len() / 2]
    };
    let (ours, free) = (apart(&ours), apart(&free));
    println!("median distance {ours} against {free}");
    // The map is known at 1024 places instead of everywhere.
    assert!(ours < 2.0 * free, "{ours} against {free}");
}

#[test]
fn without_a_wall_in_the_way_it_is_nearly_the_optimal_map() {
    let graph = graph(&[&[[0.0, 0.9], [0.1, 0.9]]]);
    let source = spread(20_000, 0, &[[[0.2, 0.2], [0.4, 0.4]]]);
    let target = spread(20_000, 1, &[[[0.5, 0.3], [0.9, 0.5]]]);
    let map = WallMap::new(&source, &target, &graph, &Progress::new()).unwrap();
    let (ours, _) = cost(&source, &around(&source, &target, &map, &graph, 0), &graph);
    let (best, _) = cost(&source, &straight(&source, &target), &graph);
    println!("{ours} against {best}");
    assert!(ours < 1.01 * best, "{ours} against {best}");
}

#[test]
fn small_sets_are_matched_too() {
    let graph = graph(&[&[[0.5, 0.2], [0.5, 0.8]]]);
    for count in [1, 2, 3, 5, 17] {
        let source = spread(count, 0, &[[[0.2, 0.3], [0.4, 0.7]]]);
        let target = spread(count, 1, &[[[0.6, 0.3], [0.8, 0.7]]]);
        let map = WallMap::new(&source, &target, &graph, &Progress::new()).unwrap();
        around(&source, &target, &map, &graph, 0);
    }
}
