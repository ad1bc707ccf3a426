#pragma once

namespace chladni::squeal {

/// Low-pass kernel for a reduction of the sampling rate: a sinc with a Blackman window and 24 zeros
/// on either side. Its cut-off is 0.87 of the highest frequency `nyquist` of the lower rate:
/// frequencies below 0.76 of `nyquist` pass within 5e-4, frequencies above `nyquist` are attenuated
/// by 74 dB. Times and frequencies have reciprocal units.

/// Number of zeros of the sinc on either side.
inline constexpr int n_sinc_zeros = 24;

/// Time beyond which the kernel is zero.
double half_width_of_sinc(double nyquist);

/// The kernel at a time; its integral over all times is 1.
double windowed_sinc(double nyquist, double time);

}  // namespace chladni::squeal
