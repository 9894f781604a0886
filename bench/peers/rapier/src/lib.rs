//! One world of Rapier, made of a scene's plain numbers; the interface is that of `../../rapier.hpp`.

#[cfg(feature = "dim2")]
use rapier2d as rapier;
#[cfg(feature = "dim3")]
use rapier3d as rapier;

use rapier::prelude::*;
use std::ffi::{c_char, c_int};

#[repr(C)]
pub struct PeerBody {
    form: c_int, // as peers::Form: ball, box, capsule
    radius: f64,
    half: f64,
    position: [f64; 3],
    velocity: [f64; 3],
    angle: f64,
    rotation: [f64; 4],
}

#[repr(C)]
pub struct PeerSlab {
    centre: [f64; 3],
    half: [f64; 3],
}

#[repr(C)]
pub struct PeerScene {
    step: f64,
    gravity: f64,
    friction: f64,
    density: f64,
    restitution: f64,
    chain: c_int,
    bodies: *const PeerBody,
    body_count: usize,
    slabs: *const PeerSlab,
    slab_count: usize,
}

#[repr(C)]
pub struct PeerPose {
    position: [f64; 3],
    angle: f64,
    rotation: [f64; 4],
}

pub struct World {
    physics: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
}

#[cfg(feature = "dim2")]
fn vector(v: &[f64; 3]) -> Vector {
    Vector::new(v[0] as Real, v[1] as Real)
}
#[cfg(feature = "dim3")]
fn vector(v: &[f64; 3]) -> Vector {
    Vector::new(v[0] as Real, v[1] as Real, v[2] as Real)
}

#[cfg(feature = "dim2")]
fn rotation(body: &PeerBody) -> Rotation {
    Rotation::new(body.angle as Real)
}
#[cfg(feature = "dim3")]
fn rotation(body: &PeerBody) -> Rotation {
    let [w, x, y, z] = body.rotation.map(|c| c as Real);
    Rotation::from_xyzw(x, y, z, w)
}

#[cfg(feature = "dim2")]
fn cuboid(half: &[f64; 3]) -> ColliderBuilder {
    ColliderBuilder::cuboid(half[0] as Real, half[1] as Real)
}
#[cfg(feature = "dim3")]
fn cuboid(half: &[f64; 3]) -> ColliderBuilder {
    ColliderBuilder::cuboid(half[0] as Real, half[1] as Real, half[2] as Real)
}

#[cfg(feature = "dim2")]
fn joint(end_of_first: Vector, end_of_second: Vector) -> GenericJoint {
    RevoluteJointBuilder::new()
        .local_anchor1(end_of_first)
        .local_anchor2(end_of_second)
        .build()
        .into()
}
#[cfg(feature = "dim3")]
fn joint(end_of_first: Vector, end_of_second: Vector) -> GenericJoint {
    SphericalJointBuilder::new()
        .local_anchor1(end_of_first)
        .local_anchor2(end_of_second)
        .build()
        .into()
}

impl World {
    fn new(scene: &PeerScene, bodies: &[PeerBody], slabs: &[PeerSlab]) -> World {
        let mut physics = PhysicsWorld::new();
        let mut down = [0.0; 3];
        down[if cfg!(feature = "dim2") { 1 } else { 2 }] = -scene.gravity;
        physics.gravity = vector(&down);
        physics.integration_parameters.dt = scene.step as Real;
        // The coefficients of a pair are the mean of its two.
        let surface = |collider: ColliderBuilder| {
            let collider = collider
                .friction(scene.friction as Real)
                .restitution(scene.restitution as Real)
                .density(scene.density as Real);
            if scene.chain != 0 {
                collider.collision_groups(InteractionGroups::none())
            } else {
                collider
            }
        };
        let ground = physics.bodies.insert(RigidBodyBuilder::fixed());
        for slab in slabs {
            let collider = surface(cuboid(&slab.half)).translation(vector(&slab.centre));
            physics
                .colliders
                .insert_with_parent(collider, ground, &mut physics.bodies);
        }
        let mut handles: Vec<RigidBodyHandle> = Vec::new();
        for body in bodies {
            let (r, h) = (body.radius as Real, body.half as Real);
            let shape = match body.form {
                0 => ColliderBuilder::ball(r),
                1 => cuboid(&[body.half; 3]),
                _ => ColliderBuilder::capsule_x(h, r),
            };
            let pose = Pose::from_parts(vector(&body.position), rotation(body));
            let builder = RigidBodyBuilder::dynamic()
                .pose(pose)
                .linvel(vector(&body.velocity))
                .can_sleep(false);
            let (handle, _) = physics.insert(builder, surface(shape));
            if scene.chain != 0 {
                let end = vector(&[0.5, 0.0, 0.0]);
                let (last, end_of_last) = match handles.last() {
                    Some(&last) => (last, end),
                    None => (ground, vector(&[0.0; 3])),
                };
                physics
                    .impulse_joints
                    .insert(last, handle, joint(end_of_last, -end), true);
            }
            handles.push(handle);
        }
        World {
            physics,
            bodies: handles,
        }
    }

    fn pose(&self, body: usize) -> PeerPose {
        let body = &self.physics.bodies[self.bodies[body]];
        let (x, q) = (body.translation(), body.rotation());
        #[cfg(feature = "dim2")]
        return PeerPose {
            position: [x.x as f64, x.y as f64, 0.0],
            angle: q.angle() as f64,
            rotation: [1.0, 0.0, 0.0, 0.0],
        };
        #[cfg(feature = "dim3")]
        return PeerPose {
            position: [x.x as f64, x.y as f64, x.z as f64],
            angle: 0.0,
            rotation: [q.w as f64, q.x as f64, q.y as f64, q.z as f64],
        };
    }
}

/// # Safety
/// `scene` and the arrays that it names are valid for the call.
#[no_mangle]
pub unsafe extern "C" fn peer_rapier_make(scene: *const PeerScene) -> *mut World {
    let scene = &*scene;
    let bodies = std::slice::from_raw_parts(scene.bodies, scene.body_count);
    let slabs = if scene.slab_count == 0 {
        &[]
    } else {
        std::slice::from_raw_parts(scene.slabs, scene.slab_count)
    };
    Box::into_raw(Box::new(World::new(scene, bodies, slabs)))
}

/// # Safety
/// `world` is from `peer_rapier_make`, here and below.
#[no_mangle]
pub unsafe extern "C" fn peer_rapier_step(world: *mut World) {
    (*world).physics.step();
}

/// # Safety
/// `out` has room for all bodies.
#[no_mangle]
pub unsafe extern "C" fn peer_rapier_poses(world: *const World, out: *mut PeerPose) {
    let world = &*world;
    for body in 0..world.bodies.len() {
        out.add(body).write(world.pose(body));
    }
}

/// # Safety
/// `world` is not used again.
#[no_mangle]
pub unsafe extern "C" fn peer_rapier_free(world: *mut World) {
    drop(Box::from_raw(world));
}

/// The version, ended by a zero.
#[no_mangle]
pub extern "C" fn peer_rapier_version() -> *const c_char {
    static VERSION: std::sync::OnceLock<std::ffi::CString> = std::sync::OnceLock::new();
    VERSION
        .get_or_init(|| std::ffi::CString::new(rapier::VERSION).unwrap_or_default())
        .as_ptr()
}
