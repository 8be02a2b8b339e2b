//! Pointer input over the image: drags, clicks and the wheel.

use crate::controls::{Controls, Mode};
use crate::keys::REGION;
use crate::picture::{ImageView, Placement};
use crate::pixel_extent::PixelExtent;
use crate::region::{self, RegionDrag};
use eframe::egui::{PointerButton, Rect, Response, Ui};
use juggler_session::{Edit, Status};

/// State of the pointer input.
#[derive(Default)]
pub struct PointerInput {
    /// Settings of camera navigation.
    pub controls: Controls,
    /// Magnification and position of the image.
    pub view: ImageView,
    /// Region that is being selected.
    pub drag: RegionDrag,
}

impl PointerInput {
    /// Handles the pointer input of one pass.
    pub fn handle(
        &mut self,
        ui: &Ui,
        response: &Response,
        placement: &Placement,
        status: &Status,
        edits: &mut Vec<Edit>,
    ) {
        self.drags(ui, response, placement, status, edits);
        self.wheel(ui, response, placement, edits);
        let place = response.interact_pointer_pos().and_then(|at| placement.film_position(at));
        if response.double_clicked_by(PointerButton::Primary) {
            edits.extend(place.map(|place| Edit::Frame(Some(place))));
        } else if response.clicked_by(PointerButton::Primary) {
            edits.extend(place.map(Edit::Focus));
        }
    }

    fn drags(&mut self, ui: &Ui, response: &Response, placement: &Placement, status: &Status, edits: &mut Vec<Edit>) {
        let (region, shift) = ui.input(|input| (input.key_down(REGION), input.modifiers.shift));
        let main = response.dragged_by(PointerButton::Primary);
        if response.drag_started_by(PointerButton::Primary) && region {
            self.drag.from = ui.input(|input| input.pointer.press_origin());
        }
        if self.drag.from.is_some() {
            self.finish_region(response, placement, edits);
            return;
        }
        if response.drag_started_by(PointerButton::Primary) && !shift && self.controls.mode == Mode::Orbit {
            let origin = ui.input(|input| input.pointer.press_origin());
            edits.extend(origin.and_then(|at| placement.film_position(at)).map(Edit::Pivot));
        }
        let delta = response.drag_delta();
        let pixels = placement.pixels_per_point();
        if response.dragged_by(PointerButton::Secondary) {
            self.view.offset += delta;
        } else if (main && shift) || response.dragged_by(PointerButton::Middle) {
            edits.extend(self.controls.pan(delta.into(), pixels, &PixelExtent::from_status(status)));
        } else if main {
            edits.extend(self.controls.drag(delta.into(), pixels, &PixelExtent::from_status(status)));
        }
    }

    fn finish_region(&mut self, response: &Response, placement: &Placement, edits: &mut Vec<Edit>) {
        if !response.drag_stopped() {
            return;
        }
        let corners = self.drag.from.take().zip(response.interact_pointer_pos());
        let region = corners.and_then(|(from, to)| region::between(placement.nearest(from), placement.nearest(to)));
        edits.extend(region.map(|region| Edit::Region(Some(region))));
    }

    fn wheel(&mut self, ui: &Ui, response: &Response, placement: &Placement, edits: &mut Vec<Edit>) {
        let Some(at) = response.hover_pos() else { return };
        let (points, zoom) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        if zoom != 1.0 {
            self.view.magnify(zoom, at, area(response), placement);
        } else {
            edits.extend(self.controls.wheel(points));
        }
    }
}

fn area(response: &Response) -> Rect {
    response.rect
}
