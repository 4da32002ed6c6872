//! The form of a job template: the part of Open Job Description, specification 2023-09, that a film needs.
//! <https://github.com/OpenJobDescription/openjd-specifications/wiki/2023-09-Template-Schemas>

use serde::Serialize;

/// A job.
#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Template {
    pub(super) specification_version: &'static str,
    pub(super) extensions: Vec<&'static str>,
    pub(super) name: String,
    pub(super) parameter_definitions: Vec<Parameter>,
    pub(super) steps: Vec<Step>,
}

/// What whoever submits the job may choose.
#[derive(Clone, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Parameter {
    pub(super) name: &'static str,
    #[serde(rename = "type")]
    pub(super) kind: &'static str,
    pub(super) description: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) object_type: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) data_flow: Option<&'static str>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) allowed_values: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) min_value: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) default: Option<Scalar>,
}

/// A value.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub(super) enum Scalar {
    Text(String),
    Whole(u32),
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Step {
    pub(super) name: &'static str,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) step_environments: Vec<Environment>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) host_requirements: Option<HostRequirements>,
    pub(super) parameter_space: ParameterSpace,
    pub(super) script: Script<TaskActions>,
}

/// What is there while tasks of a session run.
#[derive(Debug, Serialize)]
pub(super) struct Environment {
    pub(super) name: &'static str,
    pub(super) script: Script<EnvironmentActions>,
}

#[derive(Debug, Serialize)]
pub(super) struct Script<A> {
    pub(super) actions: A,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct EnvironmentActions {
    pub(super) on_enter: Action,
    pub(super) on_exit: Action,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TaskActions {
    pub(super) on_run: Action,
}

/// A command line.
#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Action {
    pub(super) command: String,
    pub(super) args: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) timeout: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) cancelation: Option<Cancelation>,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Cancelation {
    pub(super) mode: &'static str,
    pub(super) notify_period_in_seconds: u32,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ParameterSpace {
    pub(super) task_parameter_definitions: Vec<ChunkParameter>,
}

/// The frames, of which each task gets a chunk.
#[derive(Debug, Serialize)]
pub(super) struct ChunkParameter {
    pub(super) name: &'static str,
    #[serde(rename = "type")]
    pub(super) kind: &'static str,
    pub(super) range: String,
    pub(super) chunks: ChunkForm,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ChunkForm {
    pub(super) default_task_count: String,
    pub(super) range_constraint: &'static str,
}

/// Which machines can render.
#[derive(Debug, Default, PartialEq, Serialize)]
pub(super) struct HostRequirements {
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) amounts: Vec<Amount>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) attributes: Vec<Attribute>,
}

#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Amount {
    pub(super) name: &'static str,
    pub(super) min: u64,
}

#[derive(Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Attribute {
    pub(super) name: &'static str,
    pub(super) any_of: Vec<&'static str>,
}
