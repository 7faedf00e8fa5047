// Muenstermann et al. 2018, sections 3.2 and 3.3.
//
// Of all distributions of absorbance with the given moments that have some of it at z, one has it at only h + 1 places, z and
// the h roots of a kernel K(z, x); h is half the number of moments. The absorbance in front of z lies between that in front of
// z with and without that at z. At a place x it is 1 / K(x, x).
uniform float u_bias, u_overestimation;

uniform sampler2D u_absorbance, u_moments_0;
#if SHEER_MOMENTS > 4
uniform sampler2D u_moments_1;
#endif
