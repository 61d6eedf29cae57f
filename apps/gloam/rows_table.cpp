// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "rows.h"

namespace gloam::cli {
namespace {

constexpr Row::Works kYes = Row::Works::kYes;
constexpr Row::Works kPartly = Row::Works::kPartly;

constexpr Row kSphericalHarmonics[] = {
    {"SH-1",
     "Real, orthonormal basis functions of 1 to 6 bands as polynomials in x, y, z; SIMD, scalar and shader "
     "forms of one table of constants",
     kYes, "", "gloam bench sh", "math: ShBasis, Glsl, DeviceTwins"},
    {"SH-2",
     "Projection of environment maps and cube maps (texel solid angles sum to 4 pi), of functions, and of "
     "analytic lights: direction, disc, constant, gradient and daylight sky",
     kYes, "", "gloam render builtin:spheres --light disc?radius=10 --light sky:overcast",
     "math: ShProjection; scene: Sky, Environment, DistantLights, PaintLights"},
    {"SH-3",
     "Rotation by any 3x3 rotation, band by band, equal to projecting the rotated function, exact near the "
     "identity too",
     kYes, "", "gloam bench sh", "math: ShRotation"},
    {"SH-4", "Turning a zonal function to another axis by one product a coefficient", kYes, "",
     "gloam bench sh", "math: ShZonal"},
    {"SH-5", "Convolution with a zonal kernel; the clamped cosine turns light into irradiance", kYes, "",
     "gloam render builtin:furnace --technique irradiance", "math: ShConvolution; irradiance: Irradiance"},
    {"SH-6",
     "Product of two functions of any orders up to 6 by exact, sparse triple-product coefficients; square "
     "and product matrix",
     kYes, "", "gloam bench sh", "math: ShProduct"},
    {"SH-7",
     "Logarithm of a function through its product matrix, with clamped eigenvalues; tabulated for zonal "
     "visibility",
     kYes, "", "gloam bench sh", "math: ShLog"},
    {"SH-8",
     "Exponential of a function: series, optimal linear, and the hybrid of scaling and squaring, each with "
     "its error",
     kYes, "", "gloam bench sh", "math: ShExp, ExpTwins"},
    {"SH-9", "Windows against ringing: Hann, Lanczos, and the least that keeps a function non-negative", kYes,
     "", "gloam render builtin:spheres --env sky:noon",
     "math: ShWindow; irradiance: AutoWindowKeepsLightNonNegative"},
};

constexpr Row kPrecomputedTransfer[] = {
    {"PRT-1",
     "Diffuse transfer vectors a vertex: unshadowed, shadowed, and interreflected over any number of "
     "bounces; shadowed and bounced parts stored apart",
     kYes, "", "gloam bake builtin:cornell -o cornell.glb", "prt_bake: PrtBake; prt: Prt"},
    {"PRT-2",
     "Glossy transfer matrices, square or 9 to 25, with a Phong-like kernel whose exponent is chosen at run "
     "time",
     kYes, "", "gloam bake builtin:spheres --glossy on -o spheres.glb",
     "math: ShHighOrder; prt_bake: PrtGlossyBake; prt: PrtGlossy"},
    {"PRT-3",
     "The simulator: quasi-random directions, culling below the horizon, later passes only along blocked "
     "directions, caustics of specular reflectors, directions until the error is below a bound, all cores, "
     "same bits for any number of threads, progress, resume; at vertices or texels of lightmaps, "
     "vertices added where they miss a shadow",
     kYes, "", "gloam bake builtin:caustic --directions 16384 --error 0.005 -o caustic.glb",
     "prt_bake: PrtBake, PrtMirrorBake, PrtBakeTexels, PrtTessellate; prt: PrtTexels; cli_bake: Bake"},
    {"PRT-4",
     "Relighting: light turned into the object's frame, one dot product a vertex; light and object turn "
     "every frame with nothing baked again",
     kYes, "",
     "gloam render cornell.glb --technique prt --light disc?azimuth=0:0,2:360 --animate 0:2 -o turn.mp4",
     "prt: Prt, PrtRelight; scene: DistantLights; cli_lights: Lights"},
    {"PRT-5",
     "Local light: radiance that arrives at sampled points near the object each frame, blended over the "
     "vertices; objects that move apart light one another",
     kYes, "", "gloam bake builtin:lanterns --apart -o lanterns.glb", "prt: PrtLocal"},
    {"PRT-6",
     "Neighbourhood transfer: a grid of matrices round an object casts its soft shadow, its reflections and "
     "caustics on whatever passes through",
     kYes, "", "gloam bake builtin:passing --neighbourhood auto -o passing.glb",
     "prt_bake: PrtNeighbourhood; prt: PrtNeighbourhood; scene: Neighbourhood"},
    {"PRT-7", "Volumes: transfer in a density grid, single and multiple scattering", kYes, "",
     "gloam render builtin:cloud --technique prt -o cloud.png",
     "prt_bake: PrtVolume; prt: PrtVolumeFrame; scene: VolumeFile, VolumePlaces; cli_volume: Volume"},
    {"PRT-8", "Materials may vary a point, and change at run time where nothing is interreflected", kYes, "",
     "gloam bake builtin:textured --kind ds --glossy on -o textured.glb", "prt: Prt, PrtGlossy"},
    {"PRT-9",
     "The baked file is a valid .glb; transfer rides in an extension whose data are ordinary accessors, as "
     "floats or halfs",
     kYes, "", "gloam bake builtin:cornell --half --pca 16x20 -o cornell.glb",
     "scene: Transfer, WriteGlb; prt_bake: ClusteredPca, CompressTransfer; reader: Reader; cli_three_page"},
};

constexpr Row kSphereSets[] = {
    {"SS-1", "A closed mesh bounded by k spheres with little volume outside it; every surface point covered",
     kYes, "", "gloam bake spheres builtin:walker -k 26", "spheres: Spheres, Fit; cli_spheres: Spheres"},
    {"SS-2", "Sphere sets that follow skins and animation; open meshes get an answer too", kYes, "",
     "gloam render builtin:walker --show spheres --animate 0:4 -o walk.mp4",
     "spheres: PoseSpheres, Spheres.OpenAndInsideOut"},
    {"SS-3",
     "A hierarchy of spheres, cut for each cluster of receivers, blended so that shading stays continuous",
     kPartly, "use by a technique", "gloam bake spheres builtin:walker -k 40",
     "spheres: SphereTree, ClusterLog"},
};

constexpr Row kProxies[] = {
    {"PX-1",
     "Log visibility of a sphere by its angular size, turned to its direction and summed over all proxies",
     kYes, "", "gloam render builtin:walker --technique proxies --show proxies.log_visibility",
     "proxies: OneSphereOverAPlaneIsTheProjectionOfItsShadow"},
    {"PX-2", "Shadowed direct light: visibility times light convolved with the clamped cosine", kYes, "",
     "gloam render builtin:walker --technique proxies", "proxies: Proxies, ProxiesTables"},
    {"PX-3", "Indirect light of a proxy sampled at one point, weighted by the visibility of its cone", kYes,
     "", "gloam render builtin:walker --technique proxies --proxies.indirect point",
     "proxies: OneWhiteSphereInTheWhiteFurnaceIsNotSeen, OperatorsAgreeWithTheSumOverDirections"},
    {"PX-4", "Indirect light of a proxy averaged over the disc that it shows, in closed form", kYes, "",
     "gloam render builtin:walker --technique proxies --proxies.indirect averaged",
     "proxies: ClosedFormIsTheMeanOverTheDisc, PolynomialsFitAsThePaperSays, "
     "OperatorsAgreeWithTheSumOverDirections"},
    {"PX-5", "Indirect light of a proxy by the exact operator, tabulated by angular size", kYes, "",
     "gloam render builtin:walker --technique proxies --proxies.indirect exact",
     "proxies: ExactOperatorIsTheIntegralOverDirections, OperatorsAgreeWithTheSumOverDirections"},
    {"PX-6", "Overlapping proxies normalised by the visibility that they block together", kYes, "",
     "gloam render builtin:walker --technique proxies --show proxies.normalisation",
     "proxies: NormalisationOfOneSphereIsOne, OverlappingProxiesSendNoMoreThanTheyBlock"},
    {"PX-7",
     "Only receivers inside a proxy's sphere of influence are touched; the picture is that of the full sum",
     kYes, "",
     "gloam render builtin:walker --technique proxies --proxies.coverage light --proxies.accumulate splat",
     "proxies: CoverageOracleChangesThePictureByAtMostFourOf256, ReachFollowsTheLight, "
     "SplatsAndTilesShowTheSamePicture"},
    {"PX-8", "Upsampling that respects depth and normals; pixels that no coarse sample fits are shaded anew",
     kYes, "", "gloam render builtin:walker --technique proxies --proxies.divisor 8",
     "proxies: CoarseReceiversShowTheSamePicture, SlantedGroundIsUpsampledAsSmoothlyAsAPicture"},
    {"PX-9",
     "Each proxy with its own albedo; moving and skinned casters; ground and walls receive, and block as "
     "rectangles",
     kYes, "", "gloam render builtin:walker --technique proxies --animate 0:4 --turn-sky 360 -o walk.mp4",
     "renderer: ProxySet, ShadowShares, SpheresScene"},
    {"PX-10", "Beyond: receivers placed where the picture needs them"},
    {"PX-11", "Beyond: light that reaches a proxy is itself shadowed"},
    {"PX-12", "Beyond: several bounces"},
    {"PX-13", "Beyond: glossy receivers"},
};

constexpr Row kSphericalLights[] = {
    {"SL-1", "Surface samples of an object seen from its spheres, each in the segment nearest to its sphere",
     kYes, "", "gloam render builtin:squirrel --technique spherical_lights",
     "spherical_lights: SphericalLightsPreparation"},
    {"SL-2", "Albedo of each segment, textures included, as spherical harmonics about its sphere", kYes, "",
     "gloam render builtin:robot --technique spherical_lights", "spherical_lights: AlbedoIsThatOfEachSide"},
    {"SL-3",
     "First pass: light at the surface samples, shadowed by all spheres, becomes each sphere's emission",
     kYes, "", "gloam render builtin:robot --technique spherical_lights",
     "spherical_lights: KernelsAgreeWithTheirTwins, LightThatArrivesIsShadowed"},
    {"SL-4",
     "Second pass: the average radiance that a sphere sends towards a receiver, by a tabulated zonal kernel",
     kYes, "", "gloam render builtin:robot --technique spherical_lights --spherical_lights.average area",
     "spherical_lights: SphericalLightsTables, OneWhiteBallInTheWhiteFurnaceIsNotSeen"},
    {"SL-5", "Second pass: what of a sphere is seen past those nearer, as a difference of exponentials", kYes,
     "", "gloam render builtin:robot --technique spherical_lights --spherical_lights.visibility difference",
     "spherical_lights: KernelsAgreeWithTheirTwins, WhatStandsBehindIsNotSeen"},
    {"SL-6",
     "Blocking sorted by sphere or by object; spheres of one object that intersect do not block each other",
     kYes, "",
     "gloam render builtin:robot --technique spherical_lights --spherical_lights.blocking per_sphere",
     "spherical_lights: KernelsAgreeWithTheirTwins, ObjectsThatMeetAreTold"},
    {"SL-7", "Motion: moved, scaled, turned, bent, jointed; nothing is baked again", kYes, "",
     "gloam render builtin:packages --technique spherical_lights --animate 0:4 -o packages.mp4",
     "renderer: EmissionSet"},
    {"SL-8", "Hierarchy with reflection ratios at the centre of each cluster of receivers", kYes, "",
     "gloam render builtin:robot --technique spherical_lights --spherical_lights.hierarchy 0.2 --show "
     "spherical_lights.ratio",
     "spherical_lights: HierarchyKeepsTheLight"},
    {"SL-9", "Local lights as spheres with an emission of their own", kYes, "",
     "gloam render builtin:assembly --technique spherical_lights --animate 0:4 -o assembly.mp4",
     "spherical_lights: WhatGlowsLightsDirectly"},
    {"SL-10", "Receivers a pixel at reduced resolution, or a vertex", kYes, "",
     "gloam render builtin:robot --technique spherical_lights --spherical_lights.receivers vertices",
     "spherical_lights: VerticesReceive, CreasesAreLitFromScratch"},
    {"SL-11", "Beyond: several bounces"},
    {"SL-12", "Beyond: a glossy last bounce"},
    {"SL-13", "Beyond: intersecting spheres handled at run time"},
    {"SL-14", "Beyond: splatted in image space; blocking by sphere without quadratic cost", kPartly,
     "splatting", "gloam bench spherical_lights --scaling --spherical_lights.blocking per_sphere",
     "spherical_lights: KernelsAgreeWithTheirTwins"},
    {"SL-15", "Beyond: articulated deformation with surfaces sampled anew"},
};

constexpr Row kRadianceFilter[] = {
    {"RF-1",
     "Virtual point lights by quasi-random walks from every light, in independent sets, made anew each "
     "frame",
     kYes, "", "gloam render builtin:conference --env none --technique radiance_filter",
     "vpls: Walks; radiance_filter: ConvexWhiteBodyInTheWhiteFurnaceIsOne"},
    {"RF-2", "Interleaved sampling: neighbouring pixels use different sets, visibility by rays", kYes, "",
     "gloam render builtin:cornell --technique radiance_filter --radiance_filter.sets 8",
     "radiance_filter: OnAPlaneTheFilterIsBruteForce, InterleavedComesNearBruteForceForAFractionOfTheRays"},
    {"RF-3", "Each pixel keeps the radiance that arrives, in three bands, free of its own normal", kYes, "",
     "gloam render builtin:bumps --env none --technique radiance_filter --radiance_filter.views on --show "
     "radiance_filter.raw_1",
     "radiance_filter: FieldAndShadingAreTheirEquations"},
    {"RF-4",
     "A filter over exactly one block of sets that stops at edges of depth and object and crosses normals",
     kYes, "", "gloam render builtin:lamp --technique radiance_filter --radiance_filter.filter one_pass",
     "radiance_filter: FiltersAreTheSumsWrittenOut, ConstantStaysAndBackgroundStaysEmpty"},
    {"RF-5",
     "Shading after the filter: Lambert and Phong lobes projected in closed form; beyond: light from one or "
     "two places as sharp as it is",
     kYes, "", "gloam render builtin:wet_floor --env none --technique radiance_filter",
     "radiance_filter: FieldAndShadingAreTheirEquations, HighlightsOfSmallLampsAreAsSharpAsTheyAre; math: "
     "Brdf"},
    {"RF-6", "Normal maps stay crisp under the filter; the classical irradiance filter stays for comparison",
     kYes, "", "gloam bench radiance_filter --paper", "radiance_filter: NormalMapsStayCrisp"},
    {"RF-7",
     "Beyond: virtual lights chosen by what the camera sees, and light from afar that comes down there", kYes,
     "",
     "gloam render builtin:shadow --env sky:mild --technique radiance_filter --radiance_filter.candidates 4",
     "vpls: CandidatesAreChosenWhereTheCameraLooks, LightFromAfarComesDownWhereTheCameraLooks"},
    {"RF-8", "Beyond: reuse over time without ghosts"},
    {"RF-9", "Beyond: the energy that a distance bound takes is given back", kPartly,
     "what is nearer to a lit surface than half of its disc; about half comes back",
     "gloam render builtin:cornell --env none --technique radiance_filter --show indirect",
     "vpls: LightOfALitSurfaceReachesWhatFacesIt"},
};

constexpr Row kSplatting[] = {
    {"MS-1", "Reflective shadow maps of spot, directional and point lights: position, normal, reflected flux",
     kYes, "", "gloam render builtin:lamp --technique splatting --show vpls.flux",
     "vpls: FluxOfAClosedBoxIsAllThatTheLampSends, FluxOfASpotOverAWhitePlaneIsTheSpots, "
     "FluxOfASunIsIrradianceTimesArea"},
    {"MS-2",
     "Virtual point lights from the map on a grid with each cell's flux, quasi-random, or by importance",
     kYes, "", "gloam render builtin:lamp --technique splatting --splatting.sampling importance",
     "vpls: CellsAreWhatFallsOnThem, ChosenLightsFallWhereFluxIs, LightsGlideWithTheirLamp"},
    {"MS-3", "Mipmaps of the least and greatest depth and normal components", kYes, "",
     "gloam render builtin:cornell --technique splatting --splatting.debug true --show splatting.least_3",
     "splatting: NoThresholdIsTheFullSum, LevelsFitAnyPicture"},
    {"MS-4", "Splats refined where depth or normals vary, from coarse to a given finest level", kPartly,
     "a list of splats for each light, by differences of what it lights",
     "gloam render builtin:cornell --technique splatting --show splatting.light_3",
     "splatting: ManyResolutionsComeNearTheFullSumForFarLess, LevelsFitAnyPicture"},
    {"MS-5", "Light of a splat: the sum over virtual lights, bounded near them; albedo after upsampling",
     kPartly, "shadow of gloss, which is off by default",
     "gloam render builtin:statue?roughness=0.4 --env none --technique splatting --splatting.gloss true",
     "splatting: FullSumIsThatOverAllLights, InsideOfASphereIsLitEvenly, "
     "GlossOfAnEvenlyLitSphereIsItsRadiance"},
    {"MS-6",
     "Upsampling over several levels that keeps constants, stays within its sources and invents nothing",
     kYes, "", "gloam render builtin:cornell --technique splatting --splatting.upsample paper",
     "splatting: SplattingUpsampling"},
    {"MS-7", "Fine detail put back by the angle to the eye", kYes, "",
     "gloam render builtin:cornell --technique splatting --splatting.detail 0.5",
     "splatting: DetailDarkensWhatIsTurnedAway"},
    {"MS-8", "Beyond: indirect light is shadowed", kYes, "",
     "gloam render builtin:lamp --technique splatting --splatting.visibility rays",
     "splatting: RaysTakeWhatIsHiddenAndNothingElse; visibility: WallsAreInTheWayAndMove"},
    {"MS-9", "Beyond: each splat takes its own set of virtual lights", kYes, "",
     "gloam render builtin:swing --technique splatting --splatting.cluster_threshold 0.006",
     "splatting: MergedLightsComeNearAllOfThem"},
    {"MS-10", "Beyond: refinement until it converges", kYes, "",
     "gloam render builtin:cornell --technique splatting --splatting.light_threshold 0.02",
     "splatting: ManyResolutionsComeNearTheFullSumForFarLess"},
    {"MS-11", "Beyond: environment light as a source of virtual lights"},
};

constexpr Row kReference[] = {
    {"REF-1",
     "A path tracer for the same scene, lights and materials: any number of bounces, direct and indirect "
     "apart, unbiased",
     kYes, "", "gloam reference builtin:cornell --bounces 4 --parts -o cornell.exr",
     "reference: Furnace, Lights, Bounces, Lobes, Projection, PathTracer, ReferenceFile; cli_reference: "
     "Light, "
     "Interruptions"},
    {"REF-2", "Measures of error: RMSE, relative squared error, PSNR, SSIM, FLIP; difference pictures", kYes,
     "", "gloam diff frame.exr reference.exr -o where",
     "image: Metrics, Measure, Ssim, Flip, DifferencePicture, FalseColor; cli_diff: Measures, Bounds, "
     "Pictures"},
    {"REF-3", "A comparison of techniques against the reference, as a table and one page", kYes, "",
     "gloam compare builtin:columns --techniques irradiance,prt -o columns",
     "cli_compare: Results, References; cli_compare_page: Page"},
};

constexpr Row kOneFrame[] = {
    {"ONE-1", "Techniques compose in one frame; no light counted twice, none lost"},
    {"ONE-2", "A technique chosen by the scene, with the reason"},
    {"ONE-3", "An engine hands in its own device and G-buffer and gets indirect light back"},
};

constexpr RowGroup kGroups[] = {
    {"SH", "Spherical harmonics", "shared by all five papers", kSphericalHarmonics},
    {"PRT", "Precomputed radiance transfer", "Sloan, Kautz, Snyder 2002", kPrecomputedTransfer},
    {"SS", "Sphere sets", "Wang et al. 2006; Ren et al. 2006", kSphereSets},
    {"PX", "Proxies in image space", "Sloan, Govindaraju, Nowrouzezahrai, Snyder 2007", kProxies},
    {"SL", "Spherical lights", "Guerrero, Jeschke, Wimmer 2008", kSphericalLights},
    {"RF", "Radiance filtering", "Segovia, Wald 2008", kRadianceFilter},
    {"MS", "Multiresolution splatting", "Nichols, Wyman 2009", kSplatting},
    {"REF", "Ground truth and error", "the judge of all", kReference},
    {"ONE", "One frame", "beyond all five", kOneFrame},
};

}  // namespace

std::span<const RowGroup> rowGroups() {
  return kGroups;
}

}  // namespace gloam::cli
