//! Transfer functions of high dynamic range video (ITU-R BT.2100-2): the perceptual quantizer PQ and
//! hybrid log-gamma HLG. Both are scaled so that the reference white of ITU-R BT.2408-7 is 1: 203
//! cd/m² in PQ, a signal of 75 % in HLG. HLG yields scene light, without the display's system gamma.

use juggler_math::portable::{exp_f64, pow_f64};

/// Luminance of the brightest PQ signal, and of reference white (BT.2408-7, section 2.2), in cd/m².
const PQ_PEAK: f64 = 10_000.0;
const REFERENCE_WHITE: f64 = 203.0;

/// Linear value of a PQ signal from 0 to 1 (BT.2100-2, table 4, EOTF).
pub(crate) fn pq(signal: f64) -> f64 {
    const M1: f64 = 2610.0 / 16_384.0;
    const M2: f64 = 2523.0 / 4096.0 * 128.0;
    const C1: f64 = 3424.0 / 4096.0;
    const C2: f64 = 2413.0 / 4096.0 * 32.0;
    const C3: f64 = 2392.0 / 4096.0 * 32.0;
    let root = pow_f64(signal.clamp(0.0, 1.0), 1.0 / M2);
    pow_f64((root - C1).max(0.0) / (C2 - C3 * root), 1.0 / M1) * (PQ_PEAK / REFERENCE_WHITE)
}

/// Linear value of an HLG signal from 0 to 1 (BT.2100-2, table 5, inverse OETF).
pub(crate) fn hlg(signal: f64) -> f64 {
    const A: f64 = 0.178_832_77;
    const B: f64 = 0.284_668_92;
    const C: f64 = 0.559_910_73;
    /// Scene light of a signal of 75 %.
    const WHITE: f64 = 0.264_962_56;
    let signal = signal.clamp(0.0, 1.0);
    let scene = if signal <= 0.5 { signal * signal / 3.0 } else { (exp_f64((signal - C) / A) + B) / 12.0 };
    scene / WHITE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pq_and_hlg_map_the_published_signals_to_their_light() {
        // BT.2408-7, table 1: reference white is a PQ signal of 58 %, rounded, and HLG's 75 %.
        assert!((pq(0.580_69) - 1.0).abs() < 1e-3, "{}", pq(0.580_69));
        // SMPTE ST 2084: 100 cd/m² is a signal of 50.81 %, 1,000 cd/m² one of 75.18 %.
        assert!((pq(0.508_08) * 203.0 - 100.0).abs() < 0.1, "{}", pq(0.508_08) * 203.0);
        assert!((pq(0.751_83) * 203.0 - 1000.0).abs() < 1.0, "{}", pq(0.751_83) * 203.0);
        assert!(pq(0.0) == 0.0 && (pq(1.0) * 203.0 - 10_000.0).abs() < 1e-6);
        assert!((hlg(0.75) - 1.0).abs() < 1e-6, "{}", hlg(0.75));
        // Half the signal is a twelfth of the peak, where both pieces meet.
        assert!((hlg(1.0) / hlg(0.5) - 12.0).abs() < 1e-4 && (hlg(0.5 + 1e-9) / hlg(0.5) - 1.0).abs() < 1e-6);
    }
}
