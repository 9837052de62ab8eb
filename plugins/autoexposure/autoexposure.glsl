//! provides  automatic exposure: the mean of the ground's logarithmic luminance becomes middle grey
//! hook      image
//! reads     radiance of the whole picture, linear, exposed; depth
//! writes    radiance
//! source    E. Reinhard et al., Photographic Tone Reproduction for Digital Images, SIGGRAPH 2002, section 2:
//!           the log-average luminance as the key of a scene; without the darkest and brightest pixels, as
//!           cameras and games meter it

uniform float autoexposure_amount = 1.0; //@ range(0, 1) label("Amount") description("Share of the correction, in stops")
uniform float autoexposure_compensation = 0.0; //@ range(-5, 5) unit(EV) label("Compensation") description("Added to the correction")
uniform float autoexposure_limit = 4.0; //@ range(0, 12) unit(EV) label("Limit") description("Most stops up or down before the compensation")
uniform float autoexposure_low = 0.1; //@ range(0, 1) label("Low") description("Share of the darkest pixels that do not count")
uniform float autoexposure_high = 0.95; //@ range(0, 1) label("High") description("Share of the pixels below the brightest ones, which do not count")

uniform sampler2D autoexposure_scene; //@ from(core.radiance)
uniform sampler2D autoexposure_depth; //@ from(core.depth)
uniform sampler2D autoexposure_luminance;         // [stops]
uniform usamplerBuffer autoexposure_histogram;    // pixels of `luminance` for each bin
uniform sampler2D autoexposure_stops;             // what is added, one texel [stops]

const int autoexposure_bins = 256;
const float autoexposure_per_stop = 8.0;  // bins
const float autoexposure_lowest = -16.0;  // of the first bin [stops]
const float autoexposure_grey = 0.18;     // reflectance of middle grey
const float autoexposure_sky = -100.0;    // of pixels that do not count [stops]

/// Luminance of 4 x 4 pixels. Each read is the mean of four. Sky and backdrop do not count: they are large,
/// and their brightness says nothing of the light on the ground.
vec4 autoexposure_pass_luminance(in Texel t) {
    ivec2 middle = min(ivec2(4.0 * t.at_px), textureSize(autoexposure_depth, 0) - 1);
    if (texelFetch(autoexposure_depth, middle, 0).r == 0.0) return vec4(autoexposure_sky);
    vec2 pixel = 1.0 / vec2(textureSize(autoexposure_scene, 0));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i)
        sum += texture(autoexposure_scene, (4.0 * t.at_px + vec2(i % 2, i / 2) * 2.0 - 1.0) * pixel).rgb;
    float luminance = dot(0.25 * sum, vec3(0.2126, 0.7152, 0.0722));  // source: IEC 61966-2-1
    return vec4(log2(max(luminance, exp2(autoexposure_lowest))));
}

// Each work group counts on its own, then adds its counts: one write a bin instead of one a pixel.
shared uint autoexposure_counts[256];

void autoexposure_pass_histogram(in Invocation i) {
    uint own = gl_LocalInvocationIndex;  // as many as bins
    autoexposure_counts[own] = 0u;
    barrier();
    float stops = autoexposure_sky;
    if (all(lessThan(i.at.xy, i.size.xy))) stops = texelFetch(autoexposure_luminance, i.at.xy, 0).r;
    if (stops > autoexposure_sky) {
        float bin = (stops - autoexposure_lowest) * autoexposure_per_stop;
        atomicAdd(autoexposure_counts[int(clamp(bin, 0.0, 255.0))], 1u);
    }
    barrier();
    if (autoexposure_counts[own] > 0u)
        atomicAdd(autoexposure_histogram_out[own], autoexposure_counts[own]);
}

/// The mean of the histogram between two shares of its pixels [stops]; middle grey of an empty range.
float autoexposure_mean() {
    float total = 0.0;
    for (int i = 0; i < autoexposure_bins; ++i)
        total += float(texelFetch(autoexposure_histogram, i).r);
    float from = autoexposure_low * total, to = autoexposure_high * total;
    float below = 0.0, weight = 0.0, sum = 0.0;
    for (int i = 0; i < autoexposure_bins; ++i) {
        float count = float(texelFetch(autoexposure_histogram, i).r);
        float inside = max(min(below + count, to) - max(below, from), 0.0);
        sum += inside * (autoexposure_lowest + (float(i) + 0.5) / autoexposure_per_stop);
        weight += inside;
        below += count;
    }
    return weight > 0.0 ? sum / weight : log2(autoexposure_grey);
}

vec4 autoexposure_pass_stops(in Texel t) {
    float wanted = log2(autoexposure_grey) - autoexposure_mean();
    return vec4(autoexposure_amount * clamp(wanted, -autoexposure_limit, autoexposure_limit) +
                autoexposure_compensation);
}

void autoexposure_on_image(in Pixel p, inout vec3 radiance) {
    radiance *= exp2(texelFetch(autoexposure_stops, ivec2(0), 0).r);
}
