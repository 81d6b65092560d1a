/* GLSL's names in C++, so that a technique file compiles as it stands: GLM's types and functions, and
 * samplers that filter as OpenGL's specification says (3.3 core, section 3.8: REPEAT, LINEAR,
 * LINEAR_MIPMAP_LINEAR). CASES_DOUBLE makes `float` mean double. It is precompiled: GLM costs 1.4 s, once
 * instead of once a lesson. */
#ifndef TEXEL_GLSL_HPP
#define TEXEL_GLSL_HPP

/* A vector of GLM has a member for each of its swizzles, hundreds of them, and g++ walks them all for each
 * argument: that was nine tenths of the time. Left out are swizzles of four, and of a vec4's three all but
 * .xyz and .rgb. */
#include <glm/detail/qualifier.hpp>

#include <glm/detail/_swizzle.hpp>
#undef GLM_SWIZZLE2_3_MEMBERS
#undef GLM_SWIZZLE2_4_MEMBERS
#undef GLM_SWIZZLE3_4_MEMBERS
#undef GLM_SWIZZLE4_3_MEMBERS
#undef GLM_SWIZZLE4_4_MEMBERS
#define GLM_SWIZZLE2_3_MEMBERS(...)
#define GLM_SWIZZLE2_4_MEMBERS(...)
#define GLM_SWIZZLE3_4_MEMBERS(...)
#define GLM_SWIZZLE4_4_MEMBERS(...)
#define GLM_SWIZZLE4_3_MEMBERS(T, Q, x, y, z, w)                                                             \
    struct {                                                                                                 \
        detail::_swizzle<3, T, Q, 0, 1, 2, -1> x##y##z;                                                      \
    };

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/ext/vector_int2.hpp>
#include <glm/ext/vector_int3.hpp>
#include <glm/ext/vector_int4.hpp>
#include <glm/ext/vector_uint2.hpp>
#include <glm/ext/vector_uint3.hpp>
#include <glm/ext/vector_uint4.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>

#include "cases_table.h"

#undef PI /* vec.h's: a technique may have one of its own */

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#undef PI /* vec.h's: a technique file may have a constant of that name */

using Texel = float; /* float also where the next lines change the word */

/* Each precision has a namespace of its own, for both are linked into one program. */
#ifdef CASES_DOUBLE
#define float double
#define CASES_NAMESPACE in_double
#else
#define CASES_NAMESPACE in_float
#endif

namespace CASES_NAMESPACE {

using namespace glm;
/* Declared here, these hide GLM's own of the same names. */
using vec2 = glm::vec<2, float>;
using vec3 = glm::vec<3, float>;
using vec4 = glm::vec<4, float>;
using mat2 = glm::mat<2, 2, float>;
using mat3 = glm::mat<3, 3, float>;
using mat4 = glm::mat<4, 4, float>;

struct sampler2D {
    const CaseTexture *texture;
};

struct usampler2D {
    const CaseTexture *texture;
};

inline ivec2 textureSize(sampler2D sampler, int level) {
    const Image &image = sampler.texture->levels[level];
    return ivec2(image.width, image.height);
}

/* Outside of the image OpenGL promises nothing and no technique may count on it: NaN fails the case. */
inline vec4 texelFetch(sampler2D sampler, ivec2 at, int level) {
    const CaseTexture &texture = *sampler.texture;
    if (level < 0 || level >= texture.count || at.x < 0 || at.y < 0 || at.x >= texture.levels[level].width ||
        at.y >= texture.levels[level].height)
        return vec4(std::numeric_limits<float>::quiet_NaN());
    const Texel *rgba = image_at(&texture.levels[level], at.x, at.y);
    return vec4(rgba[0], rgba[1], rgba[2], rgba[3]);
}

/* The same for whole numbers, where outside of the image are some that no technique expects. */
inline uvec4 texelFetch(usampler2D sampler, ivec2 at, int level) {
    const Image &image = sampler.texture->levels[level];
    if (at.x < 0 || at.y < 0 || at.x >= image.width || at.y >= image.height) return uvec4(0xdeadbeefu);
    std::uint32_t bits[4];
    std::memcpy(bits, image_at(&image, at.x, at.y), sizeof bits);
    return uvec4(bits[0], bits[1], bits[2], bits[3]);
}

/* A whole number modulo size; fmod is exact however large the number is. */
inline int repeat(float number, int size) {
    float rest = std::fmod(number, float(size));
    return int(rest < 0 ? rest + float(size) : rest);
}

inline vec4 texture_bilinear(sampler2D sampler, vec2 uv, int level) {
    ivec2 size = textureSize(sampler, level);
    float x = uv.x * float(size.x) - float(0.5), y = uv.y * float(size.y) - float(0.5);
    if (!std::isfinite(x) || !std::isfinite(y)) return vec4(std::numeric_limits<float>::quiet_NaN());
    int x0 = repeat(std::floor(x), size.x), x1 = (x0 + 1) % size.x;
    int y0 = repeat(std::floor(y), size.y), y1 = (y0 + 1) % size.y;
    float a = x - std::floor(x), b = y - std::floor(y);
    return (1 - b) * ((1 - a) * texelFetch(sampler, ivec2(x0, y0), level) +
                      a * texelFetch(sampler, ivec2(x1, y0), level)) +
           b * ((1 - a) * texelFetch(sampler, ivec2(x0, y1), level) +
                a * texelFetch(sampler, ivec2(x1, y1), level));
}

inline vec4 textureLod(sampler2D sampler, vec2 uv, float lod) {
    float last = float(sampler.texture->count - 1);
    float level = lod > 0 ? std::fmin(lod, last) : float(0); /* and 0 for NaN */
    float part = level - std::floor(level);
    vec4 finer = texture_bilinear(sampler, uv, int(level));
    return part > 0 ? (1 - part) * finer + part * texture_bilinear(sampler, uv, int(level) + 1) : finer;
}

inline vec4 textureGrad(sampler2D sampler, vec2 uv, vec2 by_x, vec2 by_y) {
    vec2 size = vec2(textureSize(sampler, 0));
    return textureLod(sampler, uv, std::log2(std::fmax(length(by_x * size), length(by_y * size))));
}

/* The texel of a CASE_NUMBERS: the bits of its numbers. */
inline void case_numbers(uvec4 numbers, Texel *rgba) {
    for (int i = 0; i < 4; i++) {
        std::uint32_t bits = numbers[i];
        std::memcpy(&rgba[i], &bits, sizeof bits);
    }
}

inline CaseValue case_value(float x) { return {{x}, 1}; }
inline CaseValue case_value(int x) { return {{double(x)}, 1}; }
inline CaseValue case_value(bool x) { return {{double(x)}, 1}; }
inline CaseValue case_value(vec2 v) { return {{v.x, v.y}, 2}; }
inline CaseValue case_value(vec3 v) { return {{v.x, v.y, v.z}, 3}; }
inline CaseValue case_value(vec4 v) { return {{v.x, v.y, v.z, v.w}, 4}; }
inline CaseValue case_value(ivec2 v) { return case_value(vec2(v)); }
inline CaseValue case_value(ivec3 v) { return case_value(vec3(v)); }
inline CaseValue case_value(ivec4 v) { return case_value(vec4(v)); }

/* The value of a CASE_TEXTURE's expression as a texel: a number is a grey. */
template <typename Value> void case_texel(Value value, Texel *rgba) {
    vec4 texel;
    if constexpr (std::is_arithmetic_v<Value>)
        texel = vec4(vec3(float(value)), 1);
    else
        texel = vec4(value);
    for (int i = 0; i < 4; i++) rgba[i] = Texel(texel[i]);
}

} // namespace CASES_NAMESPACE

#endif
