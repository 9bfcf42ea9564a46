//! `[[joints]]`: what joins free rigid bodies to others and to the ground.

use super::Context;
use super::loads::{Varying, positive};
use super::quantity::{
    AngularVelocity, Force, ForceOverVelocity, Length, Measure, Moment, MomentOverSpin, QuantityInput, Ratio,
    Stiffness, Velocity,
};
use super::read::table;
use super::repeat::Repeat;
use super::text::Text;
use super::vector::{VectorInput, direction};
use crate::scene::error::Fault;
use crate::scene::parameters::Dependence;
use crate::scene::{self, Body, JointKind, Motor};
use std::collections::HashSet;

table! {
    /// What joins a free rigid body to another rigid body or to the ground: one of hinge, slider, planar, ball, weld and
    /// spring. Places and axes are those of the start and move with the bodies.
    Joint {
        /// Its name in joints.csv; by default "joint 1", "joint 2" ...
        name: Option<Text>,
        /// Makes many of it: indices, and how many values each has, as of [[bodies]]. By default one.
        repeat: Option<Repeat>,
        /// Name of the body that it holds, one with rigid.free.
        body: Text,
        /// Name of the rigid body to which it holds it; by default the ground.
        to: Option<Text>,
        /// Leaves turning about an axis: hinge = { point = [0, 0, 0], axis = [0, 0, 1] }.
        hinge: Option<Hinge>,
        /// Leaves sliding along a direction: slider = { axis = [1, 0] }.
        slider: Option<Slider>,
        /// Leaves moving in a plane and turning about its normal: planar = { normal = [0, 0, 1] }.
        planar: Option<Planar>,
        /// Leaves turning about a point: ball = { point = [0, 0, 0] }.
        ball: Option<BallJoint>,
        /// Leaves nothing: weld = {}.
        weld: Option<Weld>,
        /// A spring between a point of the body and one of what it is joined to; it leaves all motion.
        spring: Option<Spring>,
    }
}

table! {
    /// A hinge, and what drives it. In the plane moments are per metre of depth.
    Hinge {
        /// A point of its axis at the start [m].
        point: VectorInput<Length>,
        /// Along its axis, of any length; in three dimensions only: in the plane it is the third axis.
        axis: Option<VectorInput<Ratio>>,
        /// Moment on the body about the axis [N m]; a formula of the time t or a table varies it. By default none.
        torque: Option<Varying<Moment>>,
        /// Speed of turning that a motor keeps up [rad/s]; a formula of the time t or a table
        /// varies it. By default any.
        speed: Option<Varying<AngularVelocity>>,
        /// Largest moment of that motor [N m]; by default as large as it takes.
        limit: Option<QuantityInput<Moment>>,
        /// Moment against the angle from the start, over the angle [N m]. By default none.
        stiffness: Option<QuantityInput<Moment>>,
        /// Moment against the speed of turning, over the speed [N m s]. By default none.
        dashpot: Option<QuantityInput<MomentOverSpin>>,
    }
}

table! {
    /// A slider, and what drives it. In the plane forces are per metre of depth.
    Slider {
        /// Direction of sliding, of any length.
        axis: VectorInput<Ratio>,
        /// Force on the body along the direction [N]; a formula of the time t or a table varies it. By default none.
        force: Option<Varying<Force>>,
        /// Speed of sliding that a motor keeps up [m/s]; a formula of the time t or a table varies
        /// it. By default any.
        speed: Option<Varying<Velocity>>,
        /// Largest force of that motor [N]; by default as large as it takes.
        limit: Option<QuantityInput<Force>>,
        /// Force against the way from the start, over the way [N/m]. By default none.
        stiffness: Option<QuantityInput<Stiffness>>,
        /// Force against the speed of sliding, over the speed [N s/m]. By default none.
        dashpot: Option<QuantityInput<ForceOverVelocity>>,
    }
}

table! {
    /// A joint that leaves a body in a plane, and what turns it. In the plane moments are per metre of depth.
    Planar {
        /// Across the plane, of any length; in three dimensions only: in the plane it is the third axis.
        normal: Option<VectorInput<Ratio>>,
        /// Moment on the body about the normal [N m]; a formula of the time t or a table varies it. By default none.
        torque: Option<Varying<Moment>>,
        /// Speed of turning that a motor keeps up [rad/s]; a formula of the time t or a table
        /// varies it. By default any.
        speed: Option<Varying<AngularVelocity>>,
        /// Largest moment of that motor [N m]; by default as large as it takes.
        limit: Option<QuantityInput<Moment>>,
        /// Moment against the angle from the start, over the angle [N m]. By default none.
        stiffness: Option<QuantityInput<Moment>>,
        /// Moment against the speed of turning, over the speed [N m s]. By default none.
        dashpot: Option<QuantityInput<MomentOverSpin>>,
    }
}

table! {
    /// A ball joint.
    BallJoint {
        /// The point about which the body turns, at the start [m].
        point: VectorInput<Length>,
    }
}

table! {
    /// A weld.
    Weld {}
}

table! {
    /// A spring with a dashpot, along the line between its ends.
    Spring {
        /// Its end on the body, at the start [m].
        from: VectorInput<Length>,
        /// Its end on what the body is joined to, at the start [m].
        to: VectorInput<Length>,
        /// Force over the change of length [N/m]. By default none.
        stiffness: Option<QuantityInput<Stiffness>>,
        /// Force over the speed at which the length changes [N s/m]. By default none.
        dashpot: Option<QuantityInput<ForceOverVelocity>>,
        /// Length without a force [m]; by default that of the start.
        length: Option<QuantityInput<Length>>,
    }
}

/// Joints, and where in the file each is declared.
#[derive(Default)]
pub struct Joints {
    pub all: Vec<scene::Joint>,
    /// Of each, its table in the file: `joints[3]`.
    pub declared: Vec<String>,
}

/// The joints in the order of the file.
pub fn resolve(joints: &[Joint], (bodies, context): (&[Body], &Context)) -> Result<Joints, Fault> {
    let (mut resolved, mut taken) = (Joints::default(), HashSet::new());
    for (table, joint) in joints.iter().enumerate() {
        let declared = format!("joints[{table}]");
        Repeat::each(joint.repeat.as_ref(), context, || {
            let number = resolved.all.len() + 1;
            let name =
                Text::name_or(joint.name.as_ref(), ("joint", number), (&declared, &mut taken), context)?;
            resolved.all.push(joint.resolve(&declared, name, (bodies, context))?);
            resolved.declared.push(declared.clone());
            Ok(())
        })?;
    }
    Ok(resolved)
}

const KINDS: &str = "one of hinge, slider, planar, ball, weld and spring";

impl Joint {
    fn resolve(
        &self,
        declared: &str,
        name: String,
        (bodies, context): (&[Body], &Context),
    ) -> Result<scene::Joint, Fault> {
        let named = |text: &Text, what: &str, suits: fn(&Body) -> bool| {
            let (places, names): (Vec<usize>, Vec<&str>) = (bodies.iter().enumerate())
                .filter(|(_, body)| suits(body))
                .map(|(place, body)| (place, body.name.as_str()))
                .unzip();
            let found = text.name_of(context, what, &names)?;
            let place = names.iter().position(|name| *name == found).expect("name_of found it in names");
            Ok::<_, Fault>((places[place], found))
        };
        let what = "the name of a free rigid body, one with rigid = { free = {} }";
        let (body, _) = named(&self.body, what, |body| body.as_free_rigid().is_some())?;
        let to = match &self.to {
            None => None,
            Some(text) => {
                let (place, found) = named(text, "the name of a rigid body", Body::is_rigid)?;
                if place == body {
                    return Err(text.refused(&found, "another body than the one that it holds"));
                }
                Some(place)
            }
        };
        let mut kinds = Vec::new();
        kinds.extend(self.hinge.as_ref().map(|hinge| hinge.resolve(declared, context)));
        kinds.extend(self.slider.as_ref().map(|slider| slider.resolve(context)));
        kinds.extend(self.planar.as_ref().map(|planar| planar.resolve(declared, context)));
        kinds
            .extend(self.ball.as_ref().map(|ball| Ok(JointKind::Ball { point: ball.point.value(context)? })));
        kinds.extend(self.weld.as_ref().map(|Weld {}| Ok(JointKind::Weld)));
        kinds.extend(self.spring.as_ref().map(|spring| spring.resolve(declared, context)));
        let several = kinds.len() > 1;
        let kind = match kinds.pop() {
            Some(kind) if !several => kind?,
            Some(_) => return Err(Fault::new(declared, "a joint of several kinds", KINDS)),
            None => return Err(Fault::new(declared, "a joint of no kind", KINDS)),
        };
        Ok(scene::Joint { name, body, to, kind })
    }
}

/// A moment or force that may vary in time; by default none.
fn push<M: Measure>(input: &Option<Varying<M>>, context: &Context) -> Result<scene::Expression, Fault> {
    match input {
        None => Ok(scene::Expression::Constant(0.0)),
        Some(input) => input.resolve(context, Dependence::Time),
    }
}

/// A number above zero, or what stands for none.
fn or<M: Measure>(input: &Option<QuantityInput<M>>, none: f64, context: &Context) -> Result<f64, Fault> {
    input.as_ref().map_or(Ok(none), |input| positive(input, context))
}

/// The axis about which a joint turns: the third in the plane, where none is given, and one that must be in space.
fn axis_of_turning(
    given: Option<&VectorInput<Ratio>>,
    (key, in_plane, in_space): (String, &str, &str),
    context: &Context,
) -> Result<[f64; 3], Fault> {
    match (given, context.dimension.is_plane()) {
        (None, true) => Ok([0.0, 0.0, 1.0]),
        (Some(axis), false) => direction(axis, context),
        (Some(axis), true) => Err(axis.node().fault(in_plane)),
        (None, false) => Err(Fault::new(&key, "nothing, the key is missing", in_space)),
    }
}

impl Planar {
    fn resolve(&self, declared: &str, context: &Context) -> Result<JointKind, Fault> {
        let axis = axis_of_turning(
            self.normal.as_ref(),
            (
                format!("{declared}.planar.normal"),
                "no normal, as the scene is plane: it moves in x and y and turns about z",
                "the direction across the plane, like [0, 0, 1]",
            ),
            context,
        )?;
        let motor = Motor {
            push: push(&self.torque, context)?,
            speed: self.speed.as_ref().map(|speed| speed.resolve(context, Dependence::Time)).transpose()?,
            limit: or(&self.limit, f64::INFINITY, context)?,
            stiffness: or(&self.stiffness, 0.0, context)?,
            dashpot: or(&self.dashpot, 0.0, context)?,
        };
        limit_has_speed(&self.limit, &motor)?;
        if context.dimension.is_plane() && motor == Motor::default() {
            let allowed =
                "a `torque`, `speed`, `stiffness` or `dashpot`: in the plane a body moves so without a joint";
            return Err(Fault::new(&format!("{declared}.planar"), "a joint that does nothing", allowed));
        }
        Ok(JointKind::Planar { axis, motor })
    }
}

impl Hinge {
    fn resolve(&self, declared: &str, context: &Context) -> Result<JointKind, Fault> {
        let axis = axis_of_turning(
            self.axis.as_ref(),
            (
                format!("{declared}.hinge.axis"),
                "no axis, as the scene is plane: a hinge turns about z",
                "the direction about which it turns, like [0, 0, 1]",
            ),
            context,
        )?;
        let motor = Motor {
            push: push(&self.torque, context)?,
            speed: self.speed.as_ref().map(|speed| speed.resolve(context, Dependence::Time)).transpose()?,
            limit: or(&self.limit, f64::INFINITY, context)?,
            stiffness: or(&self.stiffness, 0.0, context)?,
            dashpot: or(&self.dashpot, 0.0, context)?,
        };
        limit_has_speed(&self.limit, &motor)?;
        Ok(JointKind::Hinge { point: self.point.value(context)?, axis, motor })
    }
}

impl Slider {
    fn resolve(&self, context: &Context) -> Result<JointKind, Fault> {
        let motor = Motor {
            push: push(&self.force, context)?,
            speed: self.speed.as_ref().map(|speed| speed.resolve(context, Dependence::Time)).transpose()?,
            limit: or(&self.limit, f64::INFINITY, context)?,
            stiffness: or(&self.stiffness, 0.0, context)?,
            dashpot: or(&self.dashpot, 0.0, context)?,
        };
        limit_has_speed(&self.limit, &motor)?;
        Ok(JointKind::Slider { axis: direction(&self.axis, context)?, motor })
    }
}

/// A limit is that of a motor which keeps up a speed.
fn limit_has_speed<M: Measure>(limit: &Option<QuantityInput<M>>, motor: &Motor) -> Result<(), Fault> {
    match limit {
        Some(limit) if motor.speed.is_none() => {
            Err(limit.node().fault("a `speed` beside it, which the motor keeps up with so much at most"))
        }
        _ => Ok(()),
    }
}

/// The length of a spring without a force, if it is not that of the start; one of a dashpot alone does nothing.
pub fn spring_length(
    length: &Option<QuantityInput<Length>>,
    stiffness: f64,
    context: &Context,
) -> Result<Option<f64>, Fault> {
    match length {
        Some(length) if stiffness == 0.0 => {
            Err(length.node().fault("a `stiffness` beside it: a dashpot alone has no length"))
        }
        length => length.as_ref().map(|length| length.positive(context)).transpose(),
    }
}

impl Spring {
    fn resolve(&self, declared: &str, context: &Context) -> Result<JointKind, Fault> {
        let points = [self.from.value(context)?, self.to.value(context)?];
        let (stiffness, dashpot) = (or(&self.stiffness, 0.0, context)?, or(&self.dashpot, 0.0, context)?);
        if stiffness == 0.0 && dashpot == 0.0 {
            let allowed = "a `stiffness`, a `dashpot` or both";
            return Err(Fault::new(&format!("{declared}.spring"), "a spring that does nothing", allowed));
        }
        if points[0] == points[1] {
            return Err(self
                .to
                .node()
                .fault("another place than `from`: a spring acts along the line between them"));
        }
        let length = spring_length(&self.length, stiffness, context)?;
        Ok(JointKind::Spring { points, length, stiffness, dashpot })
    }
}
