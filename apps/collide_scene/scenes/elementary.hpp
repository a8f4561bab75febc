// Sine, cosine and powers that have the same bits on every machine. The functions of the C library
// do not: its versions differ in the last bit, and a last bit decides whether two boxes touch.
// These use only IEEE additions, multiplications and exact scalings.
#pragma once

namespace collide_scene {

/// The sine of an angle in turns. Exactly periodic, and exactly symmetric about each quarter of a
/// turn; elsewhere within 2^-52. |turns| must be below 2^50.
[[nodiscard]] double sine(double turns) noexcept;
/// sine(turns + 1/4), exactly so for angles that are multiples of 2^-50.
[[nodiscard]] double cosine(double turns) noexcept;

/// 2^x for |x| <= 1 000, within 2^-51 of its value.
[[nodiscard]] double power_of_two(double x) noexcept;

/// The cube root of a positive, finite number, within 2^-50 of its value.
[[nodiscard]] double cube_root(double x) noexcept;

}  // namespace collide_scene
