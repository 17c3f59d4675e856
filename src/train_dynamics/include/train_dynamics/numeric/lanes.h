#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <utility>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "train_dynamics/numeric/scalar.h"

/// N doubles side by side, with the vocabulary of numeric/scalar.h: a law written over T runs on Lanes<N> and
/// gives in every lane the bits that it gives for `double`.
///
/// A pack is an array of vector registers of the width given to the compiler (-mavx2, -mavx512f; two doubles without a
/// flag), so that every N that is a multiple of the width is as fast as the machine allows. The registers are the
/// vector extension of GCC and Clang, whose comparisons, ?: and integer shifts are single instructions. Measured over a
/// draft gear's law without exponentials, std::experimental::simd is as fast in a single register (native_simd: within
/// 4 %) but takes 2.4 (SSE2), 1.8 (AVX2) and 1.2 (AVX-512) times as long for eight lanes (fixed_size_simd<double, 8>:
/// its masks are bit sets, packed and unpacked at every Select).
///
/// A pack of one register, Lanes<kNativeLanes>, is also passed between functions in a register; a wider one
/// goes through memory wherever a call is not inlined, but hides more of the latency of each instruction.
///
/// The width is a template argument: translation units compiled for different machines may be linked
/// together, because their packs, and the laws over them, are different types. (Laws over `double` are not:
/// the linker keeps one of their instances, so that a unit for a special machine should call none.)
namespace train_dynamics {

#if defined(__AVX512F__)
constexpr int kNativeLanes = 8;
#elif defined(__AVX__)
constexpr int kNativeLanes = 4;
#else
constexpr int kNativeLanes = 2;
#endif

namespace detail {

/// What packs of numbers, of bit patterns and of truth values have in common: N elements, kWidth per
/// register.
template <class Element, int N, int kWidth>
struct Registers {
  static_assert(kWidth >= 2 && N % kWidth == 0, "the number of lanes must be a multiple of the register width");
  static constexpr int kCount = N / kWidth;
  using Register [[gnu::vector_size(8 * kWidth)]] = Element;

  Element operator[](int lane) const { return reg[lane / kWidth][lane % kWidth]; }

  Register reg[kCount];
};

template <class R, class Operation, std::size_t... kIndex, class... Packs>
R ForEachRegister(Operation operation, std::index_sequence<kIndex...>, const Packs&... packs) {
  R result;
  const auto at = [&](std::size_t i) { result.reg[i] = operation(packs.reg[i]...); };
  (at(kIndex), ...);
  return result;
}

/// The pack R whose every register is `operation` of the same registers of the arguments. (Written out, not a
/// loop: GCC then keeps the packs in registers.)
template <class R, class Operation, class... Packs>
R ForEachRegister(Operation operation, const Packs&... packs) {
  return ForEachRegister<R>(operation, std::make_index_sequence<R::kCount>(), packs...);
}

}  // namespace detail

template <int N, int kWidth = (N < kNativeLanes ? N : kNativeLanes)>
struct Lanes;

/// The outcome of a comparison: in every lane all bits set (true) or none (false).
template <int N, int kWidth>
struct LaneMask : detail::Registers<std::int64_t, N, kWidth> {
  friend LaneMask operator&(const LaneMask& a, const LaneMask& b) {
    return detail::ForEachRegister<LaneMask>(std::bit_and<>(), a, b);
  }
  friend LaneMask operator|(const LaneMask& a, const LaneMask& b) {
    return detail::ForEachRegister<LaneMask>(std::bit_or<>(), a, b);
  }
  friend LaneMask operator!(const LaneMask& a) { return detail::ForEachRegister<LaneMask>(std::bit_not<>(), a); }
  friend Lanes<N, kWidth> Select(const LaneMask& mask, const Lanes<N, kWidth>& a, const Lanes<N, kWidth>& b) {
    const auto choose = [](auto m, auto x, auto y) { return m ? x : y; };
    return detail::ForEachRegister<Lanes<N, kWidth>>(choose, mask, a, b);
  }
  friend bool AnyOf(const LaneMask& mask) {
    typename LaneMask::Register any = mask.reg[0];
    for (int i = 1; i < LaneMask::kCount; ++i) any |= mask.reg[i];
    return HasBits(any);
  }
  friend bool AllOf(const LaneMask& mask) { return !AnyOf(!mask); }

 private:
  using Register = typename LaneMask::Register;
  /// Whether any lane's sign bit is set; in one instruction where there is one.
  static bool HasBits(Register any) {
#if defined(__AVX512DQ__)
    if constexpr (kWidth == 8) return _mm512_movepi64_mask(reinterpret_cast<__m512i>(any)) != 0;
#endif
#if defined(__AVX__)
    if constexpr (kWidth == 4) return _mm256_movemask_pd(reinterpret_cast<__m256d>(any)) != 0;
#endif
#if defined(__SSE2__)
    if constexpr (kWidth == 2) return _mm_movemask_pd(reinterpret_cast<__m128d>(any)) != 0;
#endif
    std::int64_t bits = 0;
    for (int lane = 0; lane < kWidth; ++lane) bits |= any[lane];
    return bits != 0;
  }
};

/// The 64-bit patterns of N numbers.
template <int N, int kWidth>
struct LaneBits : detail::Registers<std::uint64_t, N, kWidth> {
  LaneBits() = default;
  LaneBits(std::uint64_t all) {
    *this = detail::ForEachRegister<LaneBits>([all] { return all + typename LaneBits::Register{}; });
  }

  friend LaneBits operator+(const LaneBits& a, const LaneBits& b) {
    return detail::ForEachRegister<LaneBits>(std::plus<>(), a, b);
  }
  friend LaneBits operator-(const LaneBits& a, const LaneBits& b) {
    return detail::ForEachRegister<LaneBits>(std::minus<>(), a, b);
  }
  friend LaneBits operator<<(const LaneBits& a, int count) {
    return detail::ForEachRegister<LaneBits>([count](auto x) { return x << count; }, a);
  }
  friend LaneBits operator>>(const LaneBits& a, int count) {
    return detail::ForEachRegister<LaneBits>([count](auto x) { return x >> count; }, a);
  }
  friend Lanes<N, kWidth> FromBits(const LaneBits& bits) {
    using Register = typename Lanes<N, kWidth>::Register;
    const auto reinterpret = [](auto x) { return reinterpret_cast<Register>(x); };
    return detail::ForEachRegister<Lanes<N, kWidth>>(reinterpret, bits);
  }
};

/// N numbers. A double converts to a pack of equal numbers; `x[i]` reads one lane.
template <int N, int kWidth>
struct Lanes : detail::Registers<double, N, kWidth> {
  using Register = typename Lanes::Register;
  using Mask = LaneMask<N, kWidth>;
  using Bits = LaneBits<N, kWidth>;

  Lanes() = default;
  Lanes(double all) {
    // Minus, because -0.0 + 0.0 would lose the sign.
    *this = Each<Lanes>([all] { return all - Register{}; });
  }

  /// N consecutive numbers from and to memory, of any alignment.
  static Lanes Load(const double* from) {
    return Each<Lanes>([&from] {
      Register r;
      std::memcpy(&r, from, sizeof r);
      from += kWidth;
      return r;
    });
  }
  void Store(double* to) const {
    for (const Register& r : this->reg) {
      std::memcpy(to, &r, sizeof r);
      to += kWidth;
    }
  }

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return Each<Lanes>(std::plus<>(), a, b); }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return Each<Lanes>(std::minus<>(), a, b); }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return Each<Lanes>(std::multiplies<>(), a, b); }
  friend Lanes operator/(const Lanes& a, const Lanes& b) { return Each<Lanes>(std::divides<>(), a, b); }
  friend Lanes operator-(const Lanes& a) { return Each<Lanes>(std::negate<>(), a); }
  Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
  Lanes& operator-=(const Lanes& b) { return *this = *this - b; }
  Lanes& operator*=(const Lanes& b) { return *this = *this * b; }
  Lanes& operator/=(const Lanes& b) { return *this = *this / b; }

  friend Mask operator<(const Lanes& a, const Lanes& b) { return Each<Mask>(std::less<>(), a, b); }
  friend Mask operator<=(const Lanes& a, const Lanes& b) { return Each<Mask>(std::less_equal<>(), a, b); }
  friend Mask operator>(const Lanes& a, const Lanes& b) { return Each<Mask>(std::greater<>(), a, b); }
  friend Mask operator>=(const Lanes& a, const Lanes& b) { return Each<Mask>(std::greater_equal<>(), a, b); }
  friend Mask operator==(const Lanes& a, const Lanes& b) { return Each<Mask>(std::equal_to<>(), a, b); }
  friend Mask operator!=(const Lanes& a, const Lanes& b) { return Each<Mask>(std::not_equal_to<>(), a, b); }

  friend Lanes Max(const Lanes& a, const Lanes& b) {
    return Each<Lanes>([](auto x, auto y) { return x > y ? x : y; }, a, b);
  }
  friend Lanes Min(const Lanes& a, const Lanes& b) {
    return Each<Lanes>([](auto x, auto y) { return x < y ? x : y; }, a, b);
  }
  friend Lanes Clamp(const Lanes& x, const Lanes& low, const Lanes& high) { return Min(high, Max(low, x)); }

  friend Lanes Abs(const Lanes& x) { return FromBits(ToBits(x) << 1 >> 1); }
  friend Lanes CopySign(const Lanes& magnitude, const Lanes& sign) {
    return FromBits((ToBits(magnitude) << 1 >> 1) + (ToBits(sign) >> 63 << 63));
  }
  friend Lanes Sqrt(const Lanes& x) {
    return Each<Lanes>([](auto r) { return SqrtOfRegister(r); }, x);
  }

  friend Bits ToBits(const Lanes& x) {
    return Each<Bits>([](auto r) { return reinterpret_cast<typename Bits::Register>(r); }, x);
  }

 private:
  template <class R, class Operation, class... Packs>
  static R Each(Operation operation, const Packs&... packs) {
    return detail::ForEachRegister<R>(operation, packs...);
  }

  static Register SqrtOfRegister(Register x) {
#if defined(__SSE2__)
    if constexpr (kWidth == 8) {
      return _mm512_maskz_sqrt_pd(0xff, x);
    } else if constexpr (kWidth == 4) {
      return _mm256_sqrt_pd(x);
    } else {
      return _mm_sqrt_pd(x);
    }
#else
    for (int i = 0; i < kWidth; ++i) x[i] = Sqrt(x[i]);
    return x;
#endif
  }
};

template <int N, int kWidth>
struct ScalarTypes<Lanes<N, kWidth>> {
  using Mask = LaneMask<N, kWidth>;
  using Bits = LaneBits<N, kWidth>;
  static constexpr int kLanes = N;
};

template <class Function, int N, int kWidth>
Lanes<N, kWidth> MapLanes(const Function& function, const Lanes<N, kWidth>& x) {
  double values[N];
  for (int lane = 0; lane < N; ++lane) values[lane] = function(x[lane]);
  return Lanes<N, kWidth>::Load(values);
}

}  // namespace train_dynamics
