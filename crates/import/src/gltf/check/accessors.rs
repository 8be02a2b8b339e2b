//! Checks of accessors and of the types that their users need.

use super::buffers::ByteRange;
use super::checker::Checker;
use crate::gltf::document::{Accessor, ComponentType, ElementType, Index, Sparse};
use crate::gltf::location::Location;

impl Checker<'_> {
    /// Checks that the elements of accessors are inside their buffer views.
    pub(super) fn accessors(&mut self) {
        let list = Location::root("accessors");
        for (position, accessor) in self.document.accessors.iter().enumerate() {
            let at = list.index(position);
            if accessor.count.get() == 0 {
                self.fault(&at.key("count"), format_args!("0 is not a count of at least 1"));
                continue;
            }
            if accessor.normalized && matches!(accessor.component_type, ComponentType::U32 | ComponentType::F32) {
                let name = accessor.component_type.name();
                self.warn(&at, format_args!("`normalized` has no effect on {name}"));
            }
            for bounds in [&accessor.min, &accessor.max] {
                if !bounds.is_empty() && bounds.len() != accessor.element_type.components() {
                    self.warn(&at, "`min` or `max` has not the number of components");
                }
            }
            match accessor.buffer_view {
                Some(view) => self.elements(&at, accessor, view),
                None => self.decoded_size(&at, accessor),
            }
            if let Some(sparse) = &accessor.sparse {
                self.sparse(&at.key("sparse"), accessor, sparse);
            }
        }
    }

    /// Checks that the elements of an accessor are inside its buffer view.
    fn elements(&mut self, at: &Location<'_>, accessor: &Accessor, view: Index) {
        let views = &self.document.buffer_views;
        self.index(&at.key("bufferView"), view, views.len(), "bufferView");
        let Some(found) = views.get(view.get()) else { return };
        let size = accessor.element_bytes() as u64;
        let stride = found.byte_stride.map_or(accessor.packed_stride(), Index::get) as u64;
        if stride < size {
            self.fault(at, format_args!("an element has {size} bytes, bufferView {view} has a stride of {stride}"));
            return;
        }
        let offset = accessor.byte_offset.get();
        let length = (accessor.count.get() - 1).saturating_mul(stride).saturating_add(size);
        self.range(at, &ByteRange { offset, length, available: found.byte_length.get() }, "bufferView", view);
        let component = accessor.component_type.bytes() as u64;
        let is_aligned = |number: u64| number.is_multiple_of(component);
        if !(is_aligned(offset) && is_aligned(stride) && is_aligned(found.byte_offset.get().wrapping_add(offset))) {
            self.warn(at, format_args!("elements are not aligned to the {component} bytes of a component"));
        }
    }

    /// Checks the size of an accessor whose elements take no bytes of the file.
    fn decoded_size(&mut self, at: &Location<'_>, accessor: &Accessor) {
        let bytes = accessor.count.get().saturating_mul(accessor.packed_stride() as u64);
        self.count(at, bytes, self.limits.decoded_bytes, "bytes without a buffer view");
    }

    /// Checks the replaced elements of an accessor.
    fn sparse(&mut self, at: &Location<'_>, accessor: &Accessor, sparse: &Sparse) {
        let (count, all) = (sparse.count.get(), accessor.count.get());
        if count == 0 || count > all {
            self.fault(&at.key("count"), format_args!("{count} elements are replaced, there are {all}"));
            return;
        }
        let (indices, values) = (at.key("indices"), at.key("values"));
        let index_type = sparse.indices.component_type;
        if !matches!(index_type, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
            let name = index_type.name();
            self.fault(&indices.key("componentType"), format_args!("indices are {name}, expected unsigned integers"));
        }
        let length = count.saturating_mul(index_type.bytes() as u64);
        self.packed(&indices, sparse.indices.buffer_view, sparse.indices.byte_offset.get(), length);
        let stride = accessor.packed_stride() as u64;
        let length = (count - 1).saturating_mul(stride).saturating_add(accessor.element_bytes() as u64);
        self.packed(&values, sparse.values.buffer_view, sparse.values.byte_offset.get(), length);
    }

    /// Checks that packed elements are inside their buffer view.
    fn packed(&mut self, at: &Location<'_>, view: Index, offset: u64, length: u64) {
        let views = &self.document.buffer_views;
        self.index(&at.key("bufferView"), view, views.len(), "bufferView");
        if let Some(found) = views.get(view.get()) {
            self.range(at, &ByteRange { offset, length, available: found.byte_length.get() }, "bufferView", view);
        }
    }

    /// Checks an index of an accessor and the accessor's type. Returns the accessor if it exists.
    pub(super) fn typed(
        &mut self,
        at: &Location<'_>,
        index: Index,
        elements: &[ElementType],
        components: &[ComponentType],
    ) -> Option<&'_ Accessor> {
        let document = self.document;
        self.index(at, index, document.accessors.len(), "accessor");
        let accessor = document.accessors.get(index.get())?;
        if !elements.contains(&accessor.element_type) {
            let (found, expected) = (accessor.element_type.name(), names(elements, |element| element.name()));
            self.fault(at, format_args!("accessor {index} is {found}, expected {expected}"));
        }
        if !components.contains(&accessor.component_type) {
            let (found, expected) = (accessor.component_type.name(), names(components, |component| component.name()));
            self.fault(at, format_args!("accessor {index} has components of {found}, expected {expected}"));
        }
        Some(accessor)
    }

    /// Checks that the integers of an accessor are normalized.
    pub(super) fn normalized(&mut self, at: &Location<'_>, index: Index) {
        let Some(accessor) = self.document.accessors.get(index.get()) else { return };
        if accessor.component_type != ComponentType::F32 && !accessor.normalized {
            let name = accessor.component_type.name();
            self.fault(at, format_args!("accessor {index} has components of {name}, which must be normalized"));
        }
    }
}

/// Names of alternatives.
fn names<T: Copy>(all: &[T], name: impl Fn(T) -> &'static str) -> String {
    all.iter().map(|one| name(*one)).collect::<Vec<_>>().join(" or ")
}
