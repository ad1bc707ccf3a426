#pragma once

namespace chladni::squeal {

/// The kernel by which signals are brought to a lower rate: a sinc under a Blackman window with 24
/// zeros on either side. It cuts off at 0.87 of the highest frequency `nyquist` that the lower rate
/// holds: what lies below 0.76 of `nyquist` passes to 5e-4, what lies above `nyquist` is lowered by
/// 74 dB. Times and frequencies are in one unit and its inverse.

/// Zeros of the sinc on either side.
inline constexpr int n_sinc_zeros = 24;

/// Time beyond which the kernel is zero.
double half_width_of_sinc(double nyquist);

/// The kernel at a time; its integral over all times is 1.
double windowed_sinc(double nyquist, double time);

}  // namespace chladni::squeal
