//! Selection of an image region with the pointer.

use crate::picture::Placement;
use crate::style;
use eframe::egui::{Painter, Pos2, Stroke, StrokeKind};
use juggler::camera::film::Rect;

/// Minimum edge of a region, in pixels; smaller selections are ignored.
const MIN_EDGE: u32 = 4;

/// Region that is being selected.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RegionDrag {
    /// Start of the drag, in points of the screen; `None` without one.
    pub from: Option<Pos2>,
}

/// Returns the region between two pixels; `None` if it is too small.
pub fn between(a: [u32; 2], b: [u32; 2]) -> Option<Rect> {
    let [(x, width), (y, height)] =
        [0, 1].map(|axis| (a[axis].min(b[axis]), a[axis].abs_diff(b[axis]).saturating_add(1)));
    (width >= MIN_EDGE && height >= MIN_EDGE).then_some(Rect { x, y, width, height })
}

/// Draws the region that is being selected.
pub fn draw_selection(painter: &Painter, placement: &Placement, drag: RegionDrag, pointer: Option<Pos2>) {
    if let (Some(from), Some(to)) = (drag.from, pointer)
        && let Some(region) = between(placement.nearest(from), placement.nearest(to))
    {
        draw(painter, placement, &region, 2.0);
    }
}

/// Draws the outline of a region.
pub fn draw(painter: &Painter, placement: &Placement, region: &Rect, width: f32) {
    let last = [region.x + region.width.max(1) - 1, region.y + region.height.max(1) - 1];
    let edge = placement.span([region.x, region.y], last);
    painter.rect_stroke(edge, 0, Stroke::new(width, style::ACCENT), StrokeKind::Outside);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_come_in_any_order() {
        let expected = Some(Rect { x: 10, y: 20, width: 31, height: 11 });
        assert_eq!(between([10, 20], [40, 30]), expected);
        assert_eq!(between([40, 20], [10, 30]), expected);
        assert_eq!(between([10, 20], [12, 90]), None);
        assert_eq!(between([0, 0], [u32::MAX, 3]), Some(Rect { x: 0, y: 0, width: u32::MAX, height: 4 }));
    }
}
