"""Lightmesh's facets as a surface of Mitsuba: formula and table are those of crates/render/src/shading/facets.rs."""

import numpy as np

PLACES, DIRECTIONS, MIN_WIDTH, MIN_COSINE = 32, 24, 0.002, 1e-3


def table():
    """a and b by the root of the cosine, from 0 to 1, and roughness, from 0 to 1."""
    places = np.arange(PLACES) / (PLACES - 1)
    cosine = np.maximum(places**2, MIN_COSINE)[:, None, None, None]
    width = np.maximum(places**2, MIN_WIDTH)[None, :, None, None]
    u, v = ((np.arange(DIRECTIONS) + 0.5) / DIRECTIONS)[:, None], ((np.arange(DIRECTIONS) + 0.5) / DIRECTIONS)[None]
    sine = np.sqrt(1 - cosine**2)
    length = np.sqrt((width * sine) ** 2 + cosine**2)
    x, z = width * sine / length, cosine / length
    height = (1 - v) * (1 + z) - z
    ring = np.sqrt(np.maximum(1 - height**2, 0))
    half = np.stack(np.broadcast_arrays(width * (ring * np.cos(np.pi * u) + x), width * ring * np.sin(np.pi * u), height + z))
    half /= np.linalg.norm(half, axis=0)
    facing = sine * half[0] + cosine * half[2]
    light = 2 * facing * half[2] - cosine
    shadowing = lambda cosine: np.sqrt(cosine**2 * (1 - width**2) + width**2)
    with np.errstate(all="ignore"):
        left = light * (cosine + shadowing(cosine)) / (light * shadowing(cosine) + cosine * shadowing(light))
    left = np.where(light > 0, left, 0)
    away = np.maximum(1 - facing, 0) ** 5
    return np.stack([(left * (1 - away)).mean((2, 3)), (left * away).mean((2, 3))], -1).astype(np.float32)


def described(mitsuba, material):
    """The surface of a material without images."""
    color = lambda values: mitsuba.ScalarColor3f(*map(float, values))
    own = material.facets
    shares = {"metallic": own.metallic, "grazing": own.grazing, "roughness": own.roughness}
    return {"type": "facets", "base": color(material.color), "layer": color(own.layer), **shares}


def register(mitsuba, drjit):
    """Registers the surface `facets`."""
    mi, dr = mitsuba, drjit
    shares = table()

    class Facets(mi.BSDF):
        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            read = lambda name: np.array(props[name], np.float32).reshape(-1)
            self.base, self.layer = mi.Color3f(*map(float, read("base"))), mi.Color3f(*map(float, read("layer")))
            self.metallic, self.grazing = float(props["metallic"]), float(props["grazing"])
            self.roughness = float(props["roughness"])
            self.width = max(self.roughness**2, MIN_WIDTH)
            # The column of this roughness.
            place = self.roughness * (PLACES - 1)
            column = min(int(place), PLACES - 2)
            share = place - column
            mine = (1 - share) * shares[:, column] + share * shares[:, column + 1]
            self.a, self.b = mi.Float(np.ascontiguousarray(mine[:, 0])), mi.Float(np.ascontiguousarray(mine[:, 1]))
            flags = mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
            self.m_components, self.m_flags = [flags], flags
            self.lobe = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.width, True)

        def of_all(self, cosine):
            place = dr.sqrt(dr.minimum(cosine, 1)) * (PLACES - 1)
            row = dr.minimum(mi.UInt32(place), PLACES - 2)
            share = place - mi.Float(row)
            at = lambda values: dr.lerp(dr.gather(mi.Float, values, row), dr.gather(mi.Float, values, row + 1), share)
            return at(self.a), at(self.b)

        def parts(self, cosine):
            """Diffuse reflectance, f0, f90 and gain."""
            cosine = dr.maximum(cosine, MIN_COSINE)
            a, b = self.of_all(cosine)
            again = 1 / (a + b) - 1
            whole = lambda f0, f90: (a * f0 + b * f90) * (1 + again * f0)
            by_layer = whole(self.layer, self.grazing)
            mixed = lambda low, high: low + self.metallic * (high - low)
            every = mixed(by_layer, whole(self.base, mi.Float(1)))
            f0, f90 = mixed(self.layer, self.base), (1 - self.metallic) * self.grazing + self.metallic
            return (1 - self.metallic) * self.base * (1 - by_layer), f0, f90, every / (a * f0 + b * f90)

        def value(self, si, wo):
            cosine, light = mi.Frame3f.cos_theta(si.wi), mi.Frame3f.cos_theta(wo)
            kd, f0, f90, gain = self.parts(cosine)
            half = dr.normalize(si.wi + wo)
            square = self.width**2
            facing = half.z
            x = square * facing**2 + half.x**2 + half.y**2
            seen = light * dr.sqrt(cosine**2 * (1 - square) + square)
            lit = cosine * dr.sqrt(light**2 * (1 - square) + square)
            fresnel = f0 + (f90 - f0) * dr.maximum(1 - dr.dot(si.wi, half), 0) ** 5
            lobe = square / (dr.pi * x**2) * 0.5 / (seen + lit) * fresnel * gain
            return (kd * dr.inv_pi + lobe) * light

        def mirrored(self):
            return 0.5 if self.metallic < 1 else 1.0

        def density(self, si, wo):
            half = dr.normalize(si.wi + wo)
            lobe = self.lobe.pdf(si.wi, half) / (4 * dr.dot(wo, half))
            return dr.lerp(mi.warp.square_to_cosine_hemisphere_pdf(wo), lobe, self.mirrored())

        def both(self, si, wo, active):
            up = active & (mi.Frame3f.cos_theta(si.wi) > 0) & (mi.Frame3f.cos_theta(wo) > 0)
            return dr.select(up, self.value(si, wo), 0), dr.select(up, self.density(si, wo), 0)

        def sample(self, ctx, si, sample1, sample2, active):
            half, _ = self.lobe.sample(si.wi, sample2)
            wo = dr.select(sample1 < self.mirrored(), mi.reflect(si.wi, half), mi.warp.square_to_cosine_hemisphere(sample2))
            value, density = self.both(si, wo, active)
            made = dr.zeros(mi.BSDFSample3f)
            made.wo, made.pdf, made.eta = wo, density, 1.0
            made.sampled_type, made.sampled_component = mi.UInt32(+self.m_flags), mi.UInt32(0)
            return made, dr.select(density > 0, value / density, 0)

        def eval(self, ctx, si, wo, active):
            return self.both(si, wo, active)[0]

        def pdf(self, ctx, si, wo, active):
            return self.both(si, wo, active)[1]

        def eval_pdf(self, ctx, si, wo, active):
            return self.both(si, wo, active)

        def to_string(self):
            return f"Facets[roughness={self.roughness}]"

    mi.register_bsdf("facets", Facets)
